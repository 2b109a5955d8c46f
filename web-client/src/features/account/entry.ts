// Parses the input of the pages before sign-in, and returns their error texts.

import type { ApiError } from "../../net/api-error";
import { kLeastPasswordLength, type PasswordMistake } from "../../domain/people";
import { texts } from "../../texts";

/** Returns the path to open for a pasted owner link, or null for another text. */
export function loginPathOf(pasted: string): string | null {
  const found = /\/login\?link=[A-Za-z0-9._~%-]+/.exec(pasted);
  return found ? found[0] : null;
}

/**
 * Returns the secret in the fragment of an address, or an empty string without a secret. Browsers
 * do not send the fragment to the server.
 */
export const invitationOf = (hash: string): string => /^#([A-Za-z0-9._~-]+)$/.exec(hash)?.[1] ?? "";

/**
 * Returns the text for a failed sign-in. `by` is the kind of sign-in. For problems other than a
 * wrong password or token, such as too many attempts, returns the server's text.
 */
export function signInProblem(error: ApiError, by: "password" | "token"): string {
  if (by === "password") return error.status === 401 ? texts.sign_in.wrong : error.message;
  return [400, 401, 422].includes(error.status) ? texts.sign_in.token_wrong : error.message;
}

/** Returns whether the invitation itself is invalid, so no input can succeed. */
export const isUselessLink = ({ status, problem }: ApiError): boolean =>
  status === 401 || status === 404 || problem.field === "invitation";

export const passwordWords = ({ kind }: PasswordMistake): string =>
  kind === "too_short" ? texts.password.too_short(kLeastPasswordLength) : texts.password[kind];
