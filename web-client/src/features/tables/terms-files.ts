// File formats of term lists, by file name.

/** Media types of term lists. */
export type TermsType = "text/csv" | "text/turtle" | "application/rdf+xml";

const kTypes: [TermsType, string[]][] = [
  ["text/csv", ["csv", "tsv", "txt"]],
  ["text/turtle", ["ttl", "nt"]],
  ["application/rdf+xml", ["rdf", "xml", "owl"]],
];

/** For a file field. */
export const kTermsEndings = kTypes
  .flatMap(([, endings]) => endings.map((ending) => `.${ending}`))
  .join(",");

/** The media type of a file; null: not a term list. */
export function termsType(name: string): TermsType | null {
  const ending = /\.([a-z]+)$/i.exec(name)?.[1]?.toLowerCase() ?? "";
  return kTypes.find(([, endings]) => endings.includes(ending))?.[0] ?? null;
}
