// Sign-in with an OpenID Connect provider. The browser leaves the page, and the server redirects it
// back. After a failure, the query of the address contains the reason.

import { texts } from "../../texts";

const kProblem = "sign_in_problem";

/** Returns the address that begins the sign-in. `here` is the path to open after the sign-in. */
export function signOnAddress(provider: string, here: string): string {
  const address = `/sign-in/${encodeURIComponent(provider)}`;
  return here === "/" ? address : `${address}?return_to=${encodeURIComponent(here)}`;
}

/** Returns the text for the reason in a query, or an empty text without a reason. */
export function signOnProblem(search: string): string {
  const reason = new URLSearchParams(search).get(kProblem);
  if (reason === null) return "";
  const known = texts.sign_in.problems;
  return Object.hasOwn(known, reason) ? known[reason as keyof typeof known] : known.refused;
}

/** Returns the query without the reason of a failure. */
export function withoutProblem(search: string): string {
  const query = new URLSearchParams(search);
  if (!query.has(kProblem)) return search;
  query.delete(kProblem);
  const rest = query.toString();
  return rest === "" ? "" : `?${rest}`;
}
