// An Api for tests whose calls are functions: a fake server without HTTP.

import type { Api } from "../src/net/api";
import type { Call, Options } from "../src/net/calls";

type Answers = { [C in Call]?: (options: Options<C>, progress?: unknown) => unknown };

/** A call without a function makes the test fail. */
export function fakeApi(answers: Answers): Api {
  const ask = async (call: Call, options: never = {} as never): Promise<unknown> => {
    const answer = answers[call];
    if (!answer) throw new Error(`nobody answers ${call}`);
    return answer(options);
  };
  const all = async (call: Call, list: string, options: never): Promise<unknown> =>
    ((await ask(call, options)) as Record<string, unknown>)[list];
  const upload = (call: Call, options: never): unknown => ({
    done: ask(call, options),
    cancel: () => {},
  });
  const calls = { json: ask, versioned: ask, send: ask, blob: ask, deleteAsRead: ask, all, upload };
  return calls as unknown as Api;
}
