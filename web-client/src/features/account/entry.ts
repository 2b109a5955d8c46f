// Parsing of input, and error texts, for the pages before the sign-in.

import type { ApiError } from "../../net/api-error";
import { kLeastPasswordLength, type PasswordMistake } from "../../domain/people";
import { texts } from "../../texts";

/** The path to open for a pasted owner link; null for other texts. */
export function loginPathOf(pasted: string): string | null {
  const found = /\/login\?link=[A-Za-z0-9._~%-]+/.exec(pasted);
  return found ? found[0] : null;
}

/**
 * The secret in the fragment of an address, which browsers do not send to the server; empty: none.
 */
export const invitationOf = (hash: string): string => /^#([A-Za-z0-9._~-]+)$/.exec(hash)?.[1] ?? "";

/**
 * `by`: the kind of sign-in. For other problems, such as too many attempts, the server's text is
 * used.
 */
export function signInProblem(error: ApiError, by: "password" | "token"): string {
  if (by === "password") return error.status === 401 ? texts.sign_in.wrong : error.message;
  return [400, 401, 422].includes(error.status) ? texts.sign_in.token_wrong : error.message;
}

/** Whether the invitation itself is invalid, so that no input can succeed. */
export const isUselessLink = ({ status, problem }: ApiError): boolean =>
  status === 401 || status === 404 || problem.field === "invitation";

export const passwordWords = ({ kind }: PasswordMistake): string =>
  kind === "too_short" ? texts.password.too_short(kLeastPasswordLength) : texts.password[kind];
