// Rules for accounts that need no request to the server.

import type { Me, MemberGroup, Person, ProjectRole, Role } from "../core/protocol.gen";
import { kProjectRoles, kRoles } from "../core/types";

export const kLeastPasswordLength = 10; // characters, as the server counts them

/**
 * A person as answers of the server describe them: user name, full name and the color of their
 * account.
 */
export interface Named {
  user: string;
  full_name?: string;
  color?: string;
}

/** One or two letters for a person. */
export function initials({ user, full_name: fullName = "" }: Named): string {
  // "(recorded)" is no name
  const named = fullName.split(/\s+/).filter((word) => /^[\p{L}\p{N}]/u.test(word));
  const words =
    named.length > 0 ? named : user.split(/[^\p{L}\p{N}]+/u).filter((word) => word !== "");
  const [first = "?", ...rest] = words;
  const last = rest[rest.length - 1] ?? "";
  return [first, last]
    .map((word) => [...word][0] ?? "")
    .join("")
    .toUpperCase();
}

/**
 * The accessible name of a control, for screen readers and voice control: it contains the visible
 * text (WCAG 2.5.3).
 */
export function nameWith(name: string, seen: string): string {
  const said = seen.trim();
  return name.toLocaleLowerCase().includes(said.toLocaleLowerCase()) ? name : `${name} (${said})`;
}

/** The name of a person that other people see. */
export const called = ({ user, full_name: fullName = "" }: Named): string =>
  fullName.trim() || user;

/**
 * Roles that a person with the role `own` can assign, the lowest first: nobody can assign owner.
 */
export const rolesToGive = (own: Role): Role[] =>
  kRoles.slice(0, Math.min(kRoles.indexOf(own), kRoles.indexOf("administrator")) + 1);
/**
 * Roles that a token of this person can have, the lowest first. The server decides on a guest's
 * rights in projects.
 */
export const rolesOfTokens = (own: Role): Role[] =>
  own === "guest" ? [...kProjectRoles] : kRoles.slice(1, kRoles.indexOf(own) + 1);
/** The same for a token of one project, in which the person has this role. */
export const rolesOfTokensIn = (own: Role): Role[] =>
  kProjectRoles.filter((role) => kRoles.indexOf(role) <= kRoles.indexOf(own));

export type PasswordMistake = {
  field: "password" | "repeat";
  kind: "too_short" | "is_the_name" | "differs";
};

/** Checks a new password for the server's rules and for typing mistakes. */
export function passwordMistake(
  user: string,
  password: string,
  repeat: string,
): PasswordMistake | null {
  if ([...password].length < kLeastPasswordLength) return { field: "password", kind: "too_short" };
  if (password.toLowerCase() === user.toLowerCase())
    return { field: "password", kind: "is_the_name" };
  return password === repeat ? null : { field: "repeat", kind: "differs" };
}

// The first match counts: a browser also names its ancestors.
const kBrowsers: [RegExp, string][] = [
  [/\bEdg(?:e|A|iOS)?\//, "Edge"],
  [/\b(?:OPR|Opera)\//, "Opera"],
  [/\bSamsungBrowser\//, "Samsung Internet"],
  [/\b(?:Firefox|FxiOS)\//, "Firefox"],
  [/\bChromium\//, "Chromium"],
  [/\b(?:Headless)?Chrome\/|\bCriOS\//, "Chrome"],
  [/\bVersion\/[\d.]+.*\bSafari\//, "Safari"],
];
const kSystems: [RegExp, string][] = [
  [/\bAndroid\b/, "Android"],
  [/\b(?:iPhone|iPod)\b/, "iPhone"],
  [/\biPad\b/, "iPad"],
  [/\bWindows\b/, "Windows"],
  [/\bMacintosh\b/, "macOS"],
  [/\bCrOS\b/, "ChromeOS"],
  [/\bLinux\b|\bX11\b/, "Linux"],
];

/**
 * Parses a user agent: the browser's common name and its operating system; each is empty where it
 * is unknown.
 */
export function browserOf(agent: string): { browser: string; system: string } {
  const named = (list: [RegExp, string][]): string =>
    list.find(([pattern]) => pattern.test(agent))?.[1] ?? "";
  // programs other than browsers, such as curl
  const program = /^([A-Za-z][\w.-]*)\//.exec(agent)?.[1] ?? "";
  return {
    browser: named(kBrowsers) || (program === "Mozilla" ? "" : program),
    system: named(kSystems),
  };
}

/**
 * Whether `me` may change the account: nobody can change their own account here, an equal or higher
 * role, or the owner.
 */
export const mayChange = (
  me: Pick<Me, "user" | "role">,
  person: Pick<Person, "user" | "role">,
): boolean =>
  person.user !== me.user &&
  person.role !== "owner" &&
  kRoles.indexOf(person.role) < kRoles.indexOf(me.role);

/**
 * The highest role that these groups give a person in a project, and the groups that give it; null:
 * the person is in none of them.
 */
export function roleByGroups(
  given: readonly MemberGroup[],
  theirs: readonly string[],
): { role: ProjectRole; groups: string[] } | null {
  const own = given.filter(({ name }) => theirs.includes(name));
  const role = [...kProjectRoles]
    .reverse()
    .find((each) => own.some((group) => group.role === each));
  return role
    ? { role, groups: own.filter((group) => group.role === role).map(({ name }) => name) }
    : null;
}

/**
 * Finds people by words: each word must be the start of a word in the name, or in the texts that
 * `alsoOf` returns, ignoring case.
 */
export function findPeople(
  people: readonly Person[],
  text: string,
  alsoOf: (person: Person) => string,
): Person[] {
  const wanted = text
    .toLowerCase()
    .split(/\s+/)
    .filter((word) => word !== "");
  return people.filter((person) => {
    const words = `${person.user} ${person.full_name} ${alsoOf(person)}`
      .toLowerCase()
      .split(/[\s._@-]+/);
    const whole = person.user.toLowerCase();
    return wanted.every(
      (part) => whole.startsWith(part) || words.some((word) => word.startsWith(part)),
    );
  });
}

/** Whether the server accepts the name for a new account. */
export const isUserName = (name: string): boolean =>
  /^[A-Za-z0-9][A-Za-z0-9._@-]{0,63}$/.test(name);
