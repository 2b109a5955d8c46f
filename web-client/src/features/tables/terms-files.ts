// File formats of term lists, by file name.

/** Media types of term lists. */
export type TermsType = "text/csv" | "text/turtle" | "application/rdf+xml";

const kTypes: [TermsType, string[]][] = [
  ["text/csv", ["csv", "tsv", "txt"]],
  ["text/turtle", ["ttl", "nt"]],
  ["application/rdf+xml", ["rdf", "xml", "owl"]],
];

/** Endings for a file field. */
export const kTermsEndings = kTypes
  .flatMap(([, endings]) => endings.map((ending) => `.${ending}`))
  .join(",");

/** Returns the media type of a file, or null if the file is not a term list. */
export function termsType(name: string): TermsType | null {
  const ending = /\.([a-z]+)$/i.exec(name)?.[1]?.toLowerCase() ?? "";
  return kTypes.find(([, endings]) => endings.includes(ending))?.[0] ?? null;
}
