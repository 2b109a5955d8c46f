import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { textsIn } from "../../src/kiosk/texts";
import { texts } from "../../src/texts/en";
import { help } from "../../src/texts/help-en";
import { laterTexts } from "../../src/texts/later-en";

interface Phrase {
  avoid: string;
  write: string;
  case?: boolean;
}

const kPhrases = new URL("../../../tests/words/avoid.json", import.meta.url);

/**
 * Phrases to avoid in all texts (tests/words), and further phrases to avoid in the page's short
 * texts.
 */
const kAvoided: readonly [RegExp, string][] = [
  ...(JSON.parse(readFileSync(kPhrases, "utf8")) as Phrase[]).map((phrase): [RegExp, string] => [
    new RegExp(phrase.avoid, phrase.case ? "m" : "im"),
    phrase.write,
  ]),
  [/\bby itself\b/i, "automatically"],
  [/\btak(e|es|en) (it )?(back|out|away)\b/i, "undo, remove"],
  [/\bbr(ing|ings|ought) (it )?(back|over)\b/i, "restore, transfer"],
  [/\bgives? up\b/i, "cancel, discard"],
  [/\bof (his|her|their) own\b|\ba \w+ of its own\b/i, "own"],
  [/\bis (not )?here any more\b/i, "was deleted"],
  [/\bis (called|said) that\b/i, "no matching …"],
  [/\bGive (it|the \w+|a \w+|every)\b/, "Enter"],
  [/\bmay not\b/, "cannot"],
  [/\bcome (nearer|back)\b|\bcomes nearer\b/i, "zoom, return"],
  [/\ball of it\b|\bnone of (it|them)\b/i, "everything, no …"],
  [/^Who |^What [a-z]+ (is|are) /, "a noun"],
];

type Texts = { readonly [name: string]: unknown };

/** Returns undefined if the function takes another kind of argument. */
function textOf(make: unknown, argument: unknown): unknown {
  try {
    return (make as (...all: unknown[]) => unknown)(...Array(5).fill(argument));
  } catch {
    return undefined;
  }
}

/** Yields all texts with their paths, for one item and for several. */
function* sentences(of: unknown, at: string): Generator<[string, string]> {
  if (typeof of === "string") yield [at, of];
  else if (typeof of === "function")
    for (const argument of [1, 3, "Pot"])
      yield* sentences(textOf(of, argument), `${at}(${argument})`);
  else if (typeof of === "object" && of !== null)
    for (const [name, inner] of Object.entries(of as Texts))
      yield* sentences(inner, at ? `${at}.${name}` : name);
}

const awkward = (of: unknown): string[] =>
  [...sentences(of, "")].flatMap(([at, text]) =>
    kAvoided
      .filter(([pattern]) => pattern.test(text))
      .map(
        ([pattern, better]) => `${at}: “${text}”: in place of ${pattern.source} write: ${better}`,
      ),
  );

describe("The English of the page and the kiosk", () => {
  it("has none of the phrases that the guide to style avoids", () => {
    const all = { ...texts, ...laterTexts };
    expect([...sentences(all, "")].length).toBeGreaterThan(1300);
    expect(awkward(all)).toEqual([]);
    expect(awkward(help)).toEqual([]);
    expect(awkward(textsIn("en", ["en"]))).toEqual([]);
  });

  it("is refused where it has one", () => {
    expect(awkward({ saved: "It begins anew." })).toHaveLength(1);
    expect(awkward({ n: (n: number) => `${n} taken back` })).toHaveLength(3);
  });
});
