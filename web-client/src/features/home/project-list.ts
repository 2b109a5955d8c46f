// The projects that a person can choose from, with their models.

import { pageLocale } from "../../core/locale";
import type { Project } from "../../core/protocol.gen";
import { mayAdminister, mayCurate, type Me, type Model } from "../../core/types";

export const kDefaultProject = "default"; // exists on every site

export interface ListedProject {
  project: Project;
  models: readonly Model[];
}

/** Whether the person may import scans there, and delete models. */
export const curates = ({ role }: Project): boolean => role !== undefined && mayCurate(role);

/** Whether the person may revoke links for kiosks. */
export const seesToKiosks = ({ role }: Pick<Me, "role">, projects: readonly Project[]): boolean =>
  mayAdminister(role) || projects.some(curates);

/**
 * Sorts projects with models first, each part by name. The default project is omitted while it is
 * empty and others exist.
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
 * Whether the models of the project have a project page as their parent: other projects exist,
 * which may be empty.
 */
export const isOneOfSeveral = (slug: string, projects: readonly Project[]): boolean =>
  projects.length > 1 && projects.some((project) => project.slug === slug);
