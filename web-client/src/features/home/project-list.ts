// The projects that a user can choose from, with their models.

import { pageLocale } from "../../core/locale";
import type { Project } from "../../core/protocol.gen";
import { mayAdminister, mayCurate, type Me, type Model } from "../../core/types";

export const kDefaultProject = "default"; // a project that exists on every site

export interface ListedProject {
  project: Project;
  models: readonly Model[];
}

/** Returns whether the user may import scans into the project and delete its models. */
export const curates = ({ role }: Project): boolean => role !== undefined && mayCurate(role);

/** Returns whether the user may revoke kiosk links. */
export const seesToKiosks = ({ role }: Pick<Me, "role">, projects: readonly Project[]): boolean =>
  mayAdminister(role) || projects.some(curates);

/**
 * Sorts the projects by name, with empty projects last. Omits an empty default project if others
 * exist.
 */
export function listProjects(
  projects: readonly Project[],
  models: readonly Model[],
): ListedProject[] {
  const listed = projects.map((project) => ({
    project,
    models: models.filter((model) => model.project === project.slug),
  }));
  const isLeftover = ({ project, models: own }: ListedProject): boolean =>
    own.length === 0 && project.slug === kDefaultProject;
  const { compare } = new Intl.Collator(pageLocale(), { numeric: true });
  return listed
    .filter((each) => listed.length === 1 || !isLeftover(each))
    .sort(
      (a, b) =>
        Number(a.models.length === 0) - Number(b.models.length === 0) ||
        compare(a.project.name, b.project.name),
    );
}

/**
 * Returns whether the list contains this project and at least one other project, which may be
 * empty. In this case, the home link of a model leads to the page of the project.
 */
export const isOneOfSeveral = (slug: string, projects: readonly Project[]): boolean =>
  projects.length > 1 && projects.some((project) => project.slug === slug);
