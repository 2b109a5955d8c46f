// The projects that a person chooses among, with their models.

import { page_locale } from "../../core/locale";
import type { Project } from "../../core/protocol.gen";
import { may_administer, may_curate, type Me, type Model } from "../../core/types";

export const kDefaultProject = "default"; // every site has it

export interface ListedProject {
  project: Project;
  models: readonly Model[];
}

/** Whether they may import scans there, and delete models. */
export const curates = ({ role }: Project): boolean => role !== undefined && may_curate(role);

/** Whether there may be links for kiosks that are theirs to revoke. */
export const sees_to_kiosks = ({ role }: Pick<Me, "role">, projects: readonly Project[]): boolean =>
  may_administer(role) || projects.some(curates);

/**
 * Those with models first, each part by name. The project that every site has is left out while it
 * is empty and there are others.
 */
export function list_projects(
  projects: readonly Project[],
  models: readonly Model[],
): ListedProject[] {
  const listed = projects.map((project) => ({
    project,
    models: models.filter((model) => model.project === project.slug),
  }));
  const is_leftover = ({ project, models: own }: ListedProject): boolean =>
    own.length === 0 && project.slug === kDefaultProject;
  const { compare } = new Intl.Collator(page_locale(), { numeric: true });
  return listed
    .filter((each) => listed.length === 1 || !is_leftover(each))
    .sort(
      (a, b) =>
        Number(a.models.length === 0) - Number(b.models.length === 0) ||
        compare(a.project.name, b.project.name),
    );
}

/**
 * Whether the project has a page of its own to go home to from its models: there are others, which
 * may be empty.
 */
export const is_one_of_several = (slug: string, projects: readonly Project[]): boolean =>
  projects.length > 1 && projects.some((project) => project.slug === slug);
