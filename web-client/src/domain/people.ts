// Rules for accounts that need no request to the server.

import type { Me, MemberGroup, Person, ProjectRole, Role } from "../core/protocol.gen";
import { kProjectRoles, kRoles } from "../core/types";

export const kLeastPasswordLength = 10; // in characters, as counted by the server

/** A user as in the server's responses: the user name, full name and color of the account. */
export interface Named {
  user: string;
  full_name?: string;
  color?: string;
}

/** Returns one or two letters for a user. */
export function initials({ user, full_name: fullName = "" }: Named): string {
  // "(recorded)" is not a name
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
 * Returns the accessible name of a control, for screen readers and voice control. It contains the
 * visible text (WCAG 2.5.3).
 */
export function nameWith(name: string, seen: string): string {
  const said = seen.trim();
  return name.toLocaleLowerCase().includes(said.toLocaleLowerCase()) ? name : `${name} (${said})`;
}

/** Returns the displayed name of a user. */
export const called = ({ user, full_name: fullName = "" }: Named): string =>
  fullName.trim() || user;

/**
 * Returns the roles that a user with the role `own` can assign, the lowest first. No user can
 * assign the role owner.
 */
export const rolesToGive = (own: Role): Role[] =>
  kRoles.slice(0, Math.min(kRoles.indexOf(own), kRoles.indexOf("administrator")) + 1);
/**
 * Returns the roles that a token of this user can have, the lowest first. The server decides on a
 * guest's rights in projects.
 */
export const rolesOfTokens = (own: Role): Role[] =>
  own === "guest" ? [...kProjectRoles] : kRoles.slice(1, kRoles.indexOf(own) + 1);
/**
 * Returns the roles, the lowest first, that a token for only one project can have. `own` is the
 * user's role in that project.
 */
export const rolesOfTokensIn = (own: Role): Role[] =>
  kProjectRoles.filter((role) => kRoles.indexOf(role) <= kRoles.indexOf(own));

export type PasswordMistake = {
  field: "password" | "repeat";
  kind: "too_short" | "is_the_name" | "differs";
};

/** Checks whether a new password follows the server's rules and has no typing mistakes. */
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

// The first match applies, because the user agent of a browser also contains the names of older
// browsers.
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
 * Parses a user agent. Returns the common name of the browser and its operating system. An unknown
 * name is empty.
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
 * Whether `me` may change the account. Here, users can change neither their own account, nor the
 * owner's account, nor accounts whose role is as high as their own or higher.
 */
export const mayChange = (
  me: Pick<Me, "user" | "role">,
  person: Pick<Person, "user" | "role">,
): boolean =>
  person.user !== me.user &&
  person.role !== "owner" &&
  kRoles.indexOf(person.role) < kRoles.indexOf(me.role);

/**
 * Returns the highest role that these groups give a user in a project, and the groups that give it.
 * Returns null if the user is in none of these groups.
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
 * Finds users by words. Each word must be the start of a word in the name or in the text that
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
