// fast-check sends thousands of valid and invalid requests of the contract to a real server. No
// response may be an internal error. The contract must describe each response. The server must not
// execute requests that the contract forbids. STRATA_SEED repeats the requests of an earlier run.
// STRATA_OPERATION (an operationId) selects one operation. STRATA_CALLS is the number of requests to
// each operation in each of five rounds (10). Operations without a success until the last round get
// more requests in it.
import http from "node:http";
import { fc } from "../support/js/arbitraries.mjs";
import { calls_of } from "../support/js/calls.mjs";
import { Contract } from "../support/js/contract.mjs";
import { Site } from "../support/js/site.mjs";
import { kLong_ms, StrataServer } from "../support/js/strata-server.mjs";
import { kSpare } from "../support/js/vocabulary.mjs";

// each operation runs early and late, and after different operations; many more rounds would fill
// lists that have a limit (looks of a model)
const kRounds = 5;
const kCallsInRound = Number(process.env.STRATA_CALLS ?? 10); // per operation
const kCallsUntilSuccess = 20; // per operation without a success, in the last round
const kAtOnce = 4; // the limit of concurrent downloads; the server would refuse a fifth (503)
// The server reads the body of a refused request up to this size. Requests with a larger body wait
// for permission, because the server may end the connection.
const kSmallBody = 60_000;
const kFewest = 2000;

/** Operations that cannot succeed here, or that succeed only sometimes. */
const kExceptions = {
  live: "it becomes a WebSocket, which live_cases_test.py opens",
  change_password:
    "it would end the owner's sessions and the token's rights on accounts; accounts_test.py does",
  reset_demo: "the site has no demo; demo_test.py does",
  kiosk_self: "kiosks ask it, and nobody else; kiosks_test.py does",
  cancel_job: "the job may be over before it is asked to stop",
  open_owner_link:
    "once the owner has chosen a password the link is worthless; the tests in browsers open it",
};

const seed = Number(process.env.STRATA_SEED ?? 1);
const contract = new Contract();
const server = new StrataServer();
const site = new Site(server);
const agent = new http.Agent({ keepAlive: true, maxSockets: kAtOnce });
const counts = new Map(contract.operations.map(({ id }) => [id, new Map()]));
const slowest = [];
let tokens_of_test = new Set(); // ids of the test's tokens

// a lone surrogate becomes a replacement character
const as_segment = (text) => encodeURIComponent(Buffer.from(text).toString());
const secrets = () =>
  new Map([
    ["(the owner's token)", server.token],
    ["(a viewer's token)", server.viewer],
    ["(the owner's link)", new URL(server.link).searchParams.get("link")],
    ["(a kiosk's link)", site.kiosk_link],
    ["(a job)", site.job],
    ["(a figure's job)", site.figure_job],
    ["(an invitation)", site.invitations?.[0]],
    ["(an invitation to accept)", site.invitations?.[1]],
  ]);

function bytes_of(body) {
  if (body === null) return null;
  if (body.json !== undefined)
    return Buffer.from(
      [...secrets()].reduce(
        (text, [word, secret]) => text.replaceAll(word, secret),
        JSON.stringify(body.json),
      ),
    );
  if (body.text !== undefined) return Buffer.from(body.text);
  if (body.hex !== undefined) return Buffer.from(body.hex, "hex");
  if (body.file) return site.files[body.file];
  if (body.form) {
    const parts = body.form.flatMap((name) => [
      Buffer.from(
        `--XyZ\r\nContent-Disposition: form-data; name="file"; filename="${name}"\r\n\r\n`,
      ),
      site.files[name],
      Buffer.from("\r\n"),
    ]);
    return Buffer.concat([...parts, Buffer.from("--XyZ--\r\n")]);
  }
  return null;
}

/** Returns the request in its final form. */
async function request_of(operation, { path, query, headers, body, token }) {
  const known = secrets();
  let target = operation.path;
  for (const [name, text] of Object.entries(path)) {
    const would_end_the_test = operation.id === "revoke_token" && tokens_of_test.has(text);
    target = target.replace(
      `{${name}}`,
      as_segment(
        text === kSpare || would_end_the_test ? await site.spare(name) : (known.get(text) ?? text),
      ),
    );
  }
  const pairs = query.map(([name, text]) => [
    name,
    known.get(text) ?? Buffer.from(text).toString(),
  ]);
  if (pairs.length > 0)
    target += `?${pairs.map(([name, text]) => `${as_segment(name)}=${as_segment(text)}`).join("&")}`;
  const sent = Object.fromEntries(
    Object.entries(headers).map(([name, text]) => [name.toLowerCase(), text]),
  );
  if (token !== null && !operation.is_open)
    sent.authorization = `Bearer ${known.get(token) ?? token}`;
  return { method: operation.method, target, query: pairs, headers: sent, body: bytes_of(body) };
}

function send({ method, target, headers, body }) {
  return new Promise((resolve, reject) => {
    const { hostname, port } = new URL(server.url);
    const request = http.request(
      {
        agent,
        hostname,
        port,
        method,
        path: target,
        headers: { ...headers, ...(body ? { "Content-Length": body.length } : {}) },
        timeout: kLong_ms,
      },
      (answer) => {
        const chunks = [];
        const done = () =>
          resolve({
            status: answer.statusCode,
            headers: answer.headers,
            body: Buffer.concat(chunks),
          });
        answer.on("error", reject);
        answer.on("data", (chunk) => {
          chunks.push(chunk);
          if (answer.headers["content-type"] !== "text/event-stream") return;
          done(); // an event stream has no end
          request.destroy();
        });
        answer.on("end", () => {
          if (!request.writableEnded) request.destroy();
          done();
        });
      },
    );
    request.on("timeout", () =>
      request.destroy(new Error(`no answer within ${kLong_ms / 1000} s`)),
    );
    request.on("error", reject);
    if (body === null || body.length < kSmallBody) return request.end(body ?? undefined);
    request.setHeader("Expect", "100-continue");
    request.on("continue", () => request.end(body));
    return request.flushHeaders();
  });
}

const has_succeeded = (id) => [...counts.get(id).keys()].some((status) => status < 400);

async function check(operation, call) {
  const request = await request_of(operation, call);
  const begin = performance.now();
  const answer = await send(request);
  slowest.push({ id: operation.id, ms: performance.now() - begin, target: request.target });
  const tally = counts.get(operation.id);
  tally.set(answer.status, (tally.get(answer.status) ?? 0) + 1);
  const faults = contract.faults_of_answer(operation, answer);
  if (answer.status < 300)
    faults.push(
      ...contract
        .faults_of_request(operation, request)
        .map((fault) => `it was carried out although ${fault}`),
    );
  if (faults.length > 0)
    throw new Error(
      `${operation.method} ${request.target} ${answer.status}: ${faults.slice(0, 5).join("; ")}\n  ${answer.body.subarray(0, 600)}`,
    );
}

/** Runs the tasks, several at the same time. */
async function run_all(tasks) {
  const waiting = [...tasks];
  const work = async () => {
    for (let task = waiting.shift(); task; task = waiting.shift()) await task();
  };
  await Promise.all(Array.from({ length: kAtOnce }, work));
}

function tell_counts() {
  for (const [id, tally] of counts) {
    const of_class = (least) =>
      [...tally]
        .filter(([status]) => status >= least && status < least + 100)
        .reduce((sum, [, count]) => sum + count, 0);
    const refusals = [...tally]
      .filter(([status]) => status >= 400)
      .sort()
      .map(([status, count]) => `${count} × ${status}`)
      .join(", ");
    console.log(
      `${id.padEnd(28)} ${String(of_class(200) + of_class(300)).padStart(4)} done   ${refusals}`,
    );
  }
}

const failures = [];
const begin = performance.now();
try {
  console.log(`STRATA_SEED=${seed}`);
  await server.start();
  server.viewer = (await server.add_person("Vera", "viewer")).token;
  await site.make();
  const { tokens } = await server.json("GET", "/me/tokens");
  tokens_of_test = new Set(tokens.map(({ id }) => String(id)));
  const chosen = contract.operations.filter(
    ({ id }) => (process.env.STRATA_OPERATION ?? id) === id,
  );
  for (let round = 0; round < kRounds; ++round) {
    const order = fc.sample(fc.shuffledSubarray(chosen, { minLength: chosen.length }), {
      seed: seed + round,
      numRuns: 1,
    })[0];
    await run_all(
      order.map((operation) => async () => {
        if (failures.some(({ id }) => id === operation.id)) return;
        const property = fc.asyncProperty(calls_of(contract, operation), (call) =>
          check(operation, call),
        );
        const details = await fc.check(property, {
          seed: seed + 1000 * round + contract.operations.indexOf(operation),
          numRuns:
            round < kRounds - 1 || has_succeeded(operation.id)
              ? kCallsInRound
              : Math.max(kCallsInRound, kCallsUntilSuccess),
        });
        if (details.failed)
          failures.push({
            id: operation.id,
            report: `${details.errorInstance.message}\n  of ${JSON.stringify(details.counterexample[0])}`,
          });
      }),
    );
  }
  const seconds = (performance.now() - begin) / 1000;
  tell_counts();
  const sum = [...counts.values()]
    .flatMap((tally) => [...tally.values()])
    .reduce((a, b) => a + b, 0);
  console.log(
    `${sum} calls of ${chosen.length} operations in ${seconds.toFixed(0)} s, ${(sum / seconds).toFixed(0)} a second`,
  );
  for (const { ms, target } of slowest.sort((a, b) => b.ms - a.ms).slice(0, 5))
    console.log(`${(ms / 1000).toFixed(1)} s: ${target}`);
  if (failures.length > 0)
    throw new Error(
      `${failures.map(({ id, report }) => `${id}: ${report}`).join("\n\n")}\n\n${failures.length} operations failed. STRATA_SEED=${seed} makes the same calls.`,
    );
  const without = chosen
    .filter(({ id }) => !(id in kExceptions) && !has_succeeded(id))
    .map(({ id }) => id);
  if (without.length > 0) throw new Error(`no call of these succeeded: ${without.join(", ")}`);
  if (!process.env.STRATA_OPERATION && sum < kFewest) throw new Error(`only ${sum} calls`);
  if ((await server.signal("SIGTERM")) !== 0) throw new Error("the server did not end well");
  server.assert_clean_log();
} finally {
  agent.destroy();
  await server.remove();
}
