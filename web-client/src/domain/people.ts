// What can be said of accounts without asking the server.

import type { Me, MemberGroup, Person, ProjectRole, Role } from "../core/protocol.gen";
import { kProjectRoles, kRoles } from "../core/types";

export const kLeastPasswordLength = 10; // characters, as the server counts them

/**
 * Somebody as answers of the server name them: what they sign in with, what they are called, and
 * the colour of their account.
 */
export interface Named {
  user: string;
  full_name?: string;
  color?: string;
}

/** One or two letters that stand for a person. */
export function initials({ user, full_name: fullName = "" }: Named): string {
  const words =
    fullName.trim() !== ""
      ? fullName.trim().split(/\s+/)
      : user.split(/[^\p{L}\p{N}]+/u).filter((word) => word !== "");
  const [first = "?", ...rest] = words;
  const last = rest[rest.length - 1] ?? "";
  return [first, last]
    .map((word) => [...word][0] ?? "")
    .join("")
    .toUpperCase();
}

/**
 * The name of a control, for readers of the screen and for speech: what is seen on it is part of it
 * (WCAG 2.5.3).
 */
export function nameWith(name: string, seen: string): string {
  const said = seen.trim();
  return name.toLocaleLowerCase().includes(said.toLocaleLowerCase()) ? name : `${name} (${said})`;
}

/** What a person is called where others read it. */
export const called = ({ user, full_name: fullName = "" }: Named): string =>
  fullName.trim() || user;

/** Those that somebody may give away, the least first: nobody makes another owner. */
export const rolesToGive = (own: Role): Role[] =>
  kRoles.slice(0, Math.min(kRoles.indexOf(own), kRoles.indexOf("administrator")) + 1);
/**
 * Those that a token of somebody may have, the least first. What a guest may do in projects the
 * server knows.
 */
export const rolesOfTokens = (own: Role): Role[] =>
  own === "guest" ? [...kProjectRoles] : kRoles.slice(1, kRoles.indexOf(own) + 1);
/** The same of one that is good in a project alone, where they have this role. */
export const rolesOfTokensIn = (own: Role): Role[] =>
  kProjectRoles.filter((role) => kRoles.indexOf(role) <= kRoles.indexOf(own));

export type PasswordMistake = {
  field: "password" | "repeat";
  kind: "too_short" | "is_the_name" | "differs";
};

/** What the server would refuse, and a slip of the hand. */
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

// The first that fits: browsers also name those that they descend from.
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
 * Of what a browser calls itself: a name that people know, and the system that it runs on; each is
 * empty where nothing is known.
 */
export function browserOf(agent: string): { browser: string; system: string } {
  const named = (list: [RegExp, string][]): string =>
    list.find(([pattern]) => pattern.test(agent))?.[1] ?? "";
  // of what is no browser, such as curl
  const program = /^([A-Za-z][\w.-]*)\//.exec(agent)?.[1] ?? "";
  return {
    browser: named(kBrowsers) || (program === "Mozilla" ? "" : program),
    system: named(kSystems),
  };
}

/**
 * Nobody changes themselves there, nor whoever may do as much as they; the owner is changed by
 * nobody.
 */
export const mayChange = (
  me: Pick<Me, "user" | "role">,
  person: Pick<Person, "user" | "role">,
): boolean =>
  person.user !== me.user &&
  person.role !== "owner" &&
  kRoles.indexOf(person.role) < kRoles.indexOf(me.role);

/**
 * The highest role that these groups give somebody in a project, and which of them do; null: none
 * of them is theirs.
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
 * Those in whose names, or in what `alsoOf` says of them, every word of the text begins one, in
 * any case.
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

/** As the server takes it for a new account. */
export const isUserName = (name: string): boolean =>
  /^[A-Za-z0-9][A-Za-z0-9._@-]{0,63}$/.test(name);
