// What the pages before the sign-in read from what they are given, and say about refusals.

import type { ApiError } from "../core/api";
import { kLeastPasswordLength, type PasswordMistake } from "../core/people";
import { texts } from "./texts";

/** The path to open for a pasted owner link; null when it is not one. */
export function login_path_of(pasted: string): string | null {
  const found = /\/login\?link=[A-Za-z0-9._~%-]+/.exec(pasted);
  return found ? found[0] : null;
}

/** `by` is what was given. Others, such as too many tries, the server puts into plain words itself. */
export function sign_in_problem(error: ApiError, by: "password" | "token"): string {
  if (by === "password") return error.status === 401 ? texts.sign_in.wrong : error.message;
  return [400, 401, 422].includes(error.status) ? texts.sign_in.token_wrong : error.message;
}

export const password_words = ({ kind }: PasswordMistake): string =>
  kind === "too_short" ? texts.password.too_short(kLeastPasswordLength) : texts.password[kind];
