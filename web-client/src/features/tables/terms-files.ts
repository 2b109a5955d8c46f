// Files that lists of terms come in, known by their names.

/** What files of terms are sent as. */
export type TermsType = "text/csv" | "text/turtle" | "application/rdf+xml";

const kTypes: [TermsType, string[]][] = [
  ["text/csv", ["csv", "tsv", "txt"]],
  ["text/turtle", ["ttl", "nt"]],
  ["application/rdf+xml", ["rdf", "xml", "owl"]],
];

/** For a file chooser. */
export const kTermsEndings = kTypes
  .flatMap(([, endings]) => endings.map((ending) => `.${ending}`))
  .join(",");

/** What a file is sent as; null: it is no list of terms. */
export function termsType(name: string): TermsType | null {
  const ending = /\.([a-z]+)$/i.exec(name)?.[1]?.toLowerCase() ?? "";
  return kTypes.find(([, endings]) => endings.includes(ending))?.[0] ?? null;
}
