// The dialog that makes a project, or names and describes one anew.

import { ApiError, type Api, type Versioned } from "../../net/api";
import type { Project } from "../../core/protocol.gen";
import { StrataNamingDialog, type Called } from "../../ui/naming-dialog";
import { path_of_project } from "../../ui/routes";
import { texts } from "../../texts";

const words = texts.projects;

/** A change of a project, which is put over another's only once this person knows of it. */
export class ProjectChange {
  // the project as this person knows it; null: it is `project`
  private base_: Versioned<Project> | null = null;

  constructor(
    private readonly api_: Pick<Api, "project" | "change_project">,
    private readonly project_: Project,
  ) {}

  /** Null: somebody else changed it, and it is called `name` now. */
  async save({ name, text }: Called, require_if_match: boolean): Promise<Project | null> {
    const { slug } = this.project_;
    const { value, etag } = this.base_ ?? (await this.api_.project(slug));
    const known = this.base_?.value ?? this.project_;
    try {
      if (is_same(value, known))
        return await this.api_.change_project(
          slug,
          { name, description: text, require_if_match },
          etag,
        );
    } catch (error) {
      if (!(error instanceof ApiError) || error.status !== 412) throw error;
    }
    this.base_ = await this.api_.project(slug);
    return null;
  }

  get name(): string {
    return (this.base_?.value ?? this.project_).name;
  }
}

const is_same = (a: Project, b: Project): boolean =>
  a.name === b.name &&
  a.description === b.description &&
  (a.require_if_match ?? false) === (b.require_if_match ?? false);

/** The project that was made or changed; null: none was. Without `project` a new one. */
export function ask_project(api: Api, project: Project | null): Promise<Project | null> {
  let answer: Project | null = null;
  const change = project && new ProjectChange(api, project);
  const save = async (called: Called, key: string, require_if_match: boolean): Promise<string> => {
    answer = change
      ? await change.save(called, require_if_match)
      : await api.create_project({ name: called.name, description: called.text }, key);
    return answer || !change ? "" : words.changed(change.name);
  };
  const dialog = Object.assign(new StrataNamingDialog(), {
    heading: project ? words.describe_title(project.name) : words.new_title,
    lead: project ? words.describe_lead(path_of_project(project.slug)) : words.new_lead,
    yes: project ? texts.save : words.create,
    words,
    called: project && { name: project.name, text: project.description },
    option: project && {
      label: words.require_version,
      hint: words.require_version_hint,
      checked: project.require_if_match ?? false,
    },
    save,
  });
  return new Promise((resolve) => {
    dialog.addEventListener("closed", () => {
      dialog.remove();
      resolve(answer);
    });
    document.body.append(dialog);
  });
}
