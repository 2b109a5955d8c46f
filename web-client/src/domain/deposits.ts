// The metadata of a project for a repository: the fields of the form, and the record of the server.
// The form shows the usual members. Others, which scripts can set, stay unchanged.

import type { DepositAgent, DepositRecord, DepositRights } from "../core/protocol.gen";

export interface DraftCreator {
  name: string;
  orcid: string;
  /** The creator of the record, with its other members. Null for a new one. */
  before: DepositAgent | null;
}

export interface DepositDraft {
  title: string;
  creators: DraftCreator[];
  publisher: string;
  year: string;
  license: string;
  description: string;
  language: string;
  version: string;
  doi: string;
}

export const kNewCreator: DraftCreator = { name: "", orcid: "", before: null };

/** Licenses that repositories recommend for data. The server also accepts others. */
export const kUsualLicenses = ["CC0-1.0", "CC-BY-4.0", "CC-BY-SA-4.0", "CC-BY-NC-4.0"] as const;

export function draftOf(record: DepositRecord): DepositDraft {
  const rights = record.rights?.[0];
  return {
    title: record.titles?.[0]?.title ?? "",
    creators: record.creators?.map((before) => ({
      name: before.name,
      orcid: before.orcid?.replace("https://orcid.org/", "") ?? "",
      before,
    })) ?? [kNewCreator],
    publisher: record.publisher?.name ?? "",
    year: record.year?.toString() ?? "",
    license: rights?.license ?? rights?.uri ?? "",
    description: record.descriptions?.[0]?.text ?? "",
    language: record.language ?? "",
    version: record.version ?? "",
    doi: record.doi ?? "",
  };
}

/** Returns the record with the values of the form. Empty fields are left out. */
export function recordOf(draft: DepositDraft, before: DepositRecord): DepositRecord {
  const record: DepositRecord = { ...before };
  const set = <K extends keyof DepositRecord>(key: K, value: DepositRecord[K] | null): void => {
    if (value === null) delete record[key];
    else record[key] = value;
  };
  const text = (value: string): string | null => value.trim() || null;
  // Replaces the first entry of a list, which is the one that the form shows.
  const first = <T>(entry: T | null, list: readonly T[] | undefined): T[] | null => {
    const all = [...(entry === null ? [] : [entry]), ...(list ?? []).slice(1)];
    return all.length > 0 ? all : null;
  };
  const title = text(draft.title);
  set("titles", first(title ? { ...before.titles?.[0], title } : null, before.titles));
  const creators = draft.creators.filter(({ name }) => name.trim()).map(agentOf);
  set("creators", creators.length > 0 ? creators : null);
  const publisher = text(draft.publisher);
  const isSame = publisher === before.publisher?.name;
  set("publisher", publisher ? (isSame ? before.publisher! : { name: publisher }) : null);
  set("year", text(draft.year) ? Number(draft.year) : null);
  set("rights", first(rightsOf(draft.license, before), before.rights));
  const description = text(draft.description);
  set(
    "descriptions",
    first(
      description ? { ...before.descriptions?.[0], text: description } : null,
      before.descriptions,
    ),
  );
  set("language", text(draft.language));
  set("version", text(draft.version));
  set("doi", text(draft.doi));
  return record;
}

function agentOf({ name, orcid, before }: DraftCreator): DepositAgent {
  const agent: DepositAgent = { ...before, name: name.trim() };
  if (orcid.trim()) agent.orcid = orcid.trim();
  else delete agent.orcid;
  return agent;
}

function rightsOf(given: string, before: DepositRecord): DepositRights | null {
  const license = given.trim();
  if (!license) return null;
  const known = before.rights?.[0];
  if (known && license === (known.license ?? known.uri)) return known;
  return /^[a-z]+:/i.test(license) ? { uri: license } : { license };
}

/** The name of the form's field for a member that the server names: `creators[1].orcid`. */
export function fieldOf(member: string): string {
  const creator = /^creators\[(\d+)\]\.(name|orcid)/.exec(member);
  if (creator) return `creator_${creator[2]}_${creator[1]}`;
  const names: Record<string, string> = {
    titles: "title",
    creators: "creator_name_0",
    publisher: "publisher",
    year: "year",
    rights: "license",
    descriptions: "description",
    language: "language",
    version: "version",
    doi: "doi",
  };
  return names[/^\w+/.exec(member)?.[0] ?? ""] ?? "";
}
