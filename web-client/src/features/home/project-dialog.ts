// The dialog that creates a project, or changes its name and description.

import { ApiError } from "../../net/api-error";
import type { Api, Versioned } from "../../net/api";
import type { Project } from "../../core/protocol.gen";
import { StrataNamingDialog, type Called } from "../../ui/naming-dialog";
import { pathOfProject } from "../../ui/routes";
import { texts } from "../../texts";

const words = texts.projects;

/**
 * A change to a project. It overwrites another user's change only after this user has seen that
 * change.
 */
export class ProjectChange {
  // the version that this user has seen; null for `project`
  private _base: Versioned<Project> | null = null;

  constructor(
    private readonly _api: Api,
    private readonly _project: Project,
  ) {}

  /** Returns null if another user has changed the project, and `name` returns the new name. */
  async save({ name, text }: Called, requireIfMatch: boolean): Promise<Project | null> {
    const { slug } = this._project;
    const { value, etag } =
      this._base ??
      (await this._api.versioned("GET /projects/{project}", { path: { project: slug } }));
    const known = this._base?.value ?? this._project;
    try {
      if (isSame(value, known))
        return await this._api.json("PATCH /projects/{project}", {
          path: { project: slug },
          body: { name, description: text, require_if_match: requireIfMatch },
          header: { "If-Match": etag },
        });
    } catch (error) {
      if (!(error instanceof ApiError) || error.status !== 412) throw error;
    }
    this._base = await this._api.versioned("GET /projects/{project}", { path: { project: slug } });
    return null;
  }

  get name(): string {
    return (this._base?.value ?? this._project).name;
  }
}

const isSame = (a: Project, b: Project): boolean =>
  a.name === b.name &&
  a.description === b.description &&
  (a.require_if_match ?? false) === (b.require_if_match ?? false);

/**
 * Creates a project, or changes `project` if it is not null. Resolves to the project, or to null if
 * the user cancels.
 */
export function askProject(api: Api, project: Project | null): Promise<Project | null> {
  let answer: Project | null = null;
  const change = project && new ProjectChange(api, project);
  const save = async (called: Called, key: string, requireIfMatch: boolean): Promise<string> => {
    answer = change
      ? await change.save(called, requireIfMatch)
      : await api.json("POST /projects", {
          body: { name: called.name, description: called.text },
          header: { "Idempotency-Key": key },
        });
    return answer || !change ? "" : words.changed(change.name);
  };
  const dialog = Object.assign(new StrataNamingDialog(), {
    heading: project ? words.describe_title(project.name) : words.new_title,
    lead: project ? words.describe_lead(pathOfProject(project.slug)) : words.new_lead,
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
