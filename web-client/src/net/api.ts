// The HTTP interface with typed results. Every failure, also a lost network, becomes an ApiError
// that carries a problem a person can read.

import type { CameraMessage } from "../math/camera";
import { page_locale, person_languages } from "../core/locale";
import { own_problems } from "../core/problems";
import type * as wire from "../core/protocol.gen";
import {
  complete_layer,
  type Job,
  type Layer,
  type LayerCreate,
  type LayerPatch,
  type Me,
  type Model,
  type ModelPatch,
  type ProblemBody,
  type Statistics,
  type Transfer,
  type VertexPropertyName,
} from "../core/types";

export class ApiError extends Error {
  constructor(readonly problem: ProblemBody) {
    super(problem.detail ?? problem.title);
    this.name = "ApiError";
  }
  get status(): number {
    return this.problem.status;
  }
}

export interface Versioned<T> {
  value: T;
  etag: string;
}

export type Fetch = (input: string, init?: RequestInit) => Promise<Response>;

type Id = number | string;

/** A file and what it is called by the others of its scan, with folders. */
export interface UploadFile {
  file: File;
  path: string;
}

export interface Upload<T> {
  /** Resolves with the answer. */
  done: Promise<T>;
  cancel(): void;
}

type Progress = (share: number) => void;

/**
 * A line over a surface: under a path of a camera's pixels, or through places, where each step is
 * the nearest of the surface. `layers`: absent for all.
 */
export type ProfileLine = (
  | { camera: CameraMessage; path: readonly (readonly [number, number])[] }
  | { places: readonly (readonly [number, number, number])[]; step_mm: number }
) & { layers?: readonly string[] };

/** Records of a table, or of the table whose keys a layer holds. */
export type RecordPlace = { table: Id } | { model: Id; layer: Id };

export interface RecordQuery {
  sortby?: string;
  filter?: string; // CQL2 text
  limit: number;
  offset: number;
}

/** Of a table for a spreadsheet: `lang` is the language in which terms stand in it. */
export interface SheetQuery {
  f: "csv" | "xlsx";
  lang: string;
  separator: "comma" | "semicolon";
}

export interface TermQuery {
  q?: string;
  lang: string;
  limit: number;
  offset: number;
}

/** What files of terms are sent as. */
export type TermsType = "text/csv" | "text/turtle" | "application/rdf+xml";

export interface TemplateMade {
  tables: wire.Table[];
  layers: Layer[];
}

export type TexelsOfDeleted = { what: "refuse" | "clear" } | { what: "reassign"; to: number };

const kBase = "/api/v1";

export class Api {
  constructor(
    private readonly fetch_: Fetch = (input, init) => fetch(input, init),
    private readonly make_request_: () => XMLHttpRequest = () => new XMLHttpRequest(),
  ) {}

  async me(): Promise<Me> {
    return this.json("GET", "/me");
  }
  async login(who: { user: string; password: string } | { token: string }): Promise<Me> {
    return this.json("POST", "/login", who);
  }
  async logout(): Promise<void> {
    await this.request("POST", "/logout");
  }
  async change_me(change: wire.MePatch): Promise<Me> {
    return this.json("PATCH", "/me", change);
  }
  /** How this person shows the layers of a model, for them alone. Goes on when the page is left. */
  async keep_personal_view(model: Id, view: wire.PersonalView): Promise<void> {
    const body = JSON.stringify(view);
    const path = `/me/models/${encodeURIComponent(model)}/view`;
    await this.request_raw(
      "PUT",
      path,
      body,
      { "Content-Type": "application/json" },
      undefined,
      body.length < kMostKeptAlive,
    );
  }
  /** Ends all other sessions. */
  async change_password(change: wire.PasswordChange): Promise<void> {
    await this.request("POST", "/me/password", change);
  }
  /** Where this person is signed in, the newest first. */
  async sign_in_sessions(): Promise<wire.SignInSession[]> {
    return this.all("/me/sessions", "sessions");
  }
  async end_session(id: number): Promise<void> {
    await this.request("DELETE", `/me/sessions/${id}`);
  }
  async end_other_sessions(): Promise<void> {
    await this.request("DELETE", "/me/sessions");
  }
  async script_tokens(): Promise<wire.ScriptToken[]> {
    return this.all("/me/tokens", "tokens");
  }
  async create_token(token: wire.ScriptTokenCreate): Promise<wire.ScriptTokenMade> {
    return this.json("POST", "/me/tokens", token);
  }
  async revoke_token(id: number): Promise<void> {
    await this.request("DELETE", `/me/tokens/${id}`);
  }

  /** Whose invitation it is. */
  async show_invitation(invitation: string): Promise<wire.Person> {
    return this.json("POST", "/invitations/show", { invitation });
  }
  /** Opens a session. */
  async accept_invitation(accept: wire.InvitationAccept): Promise<Me> {
    return this.json("POST", "/invitations/accept", accept);
  }

  /** By name. */
  async people(): Promise<wire.Person[]> {
    return this.all("/users", "users");
  }
  async invite(person: wire.PersonCreate): Promise<wire.Invitation> {
    return this.json("POST", "/users", person);
  }
  /** Earlier links become worthless. */
  async invite_again(user: string): Promise<wire.Invitation> {
    return this.json("POST", `${person_path(user)}/invite`);
  }
  async change_person(user: string, change: wire.PersonPatch): Promise<wire.Person> {
    return this.json("PATCH", person_path(user), change);
  }
  async delete_person(user: string): Promise<void> {
    await this.request("DELETE", person_path(user));
  }

  async projects(): Promise<wire.Project[]> {
    return this.all("/projects", "projects");
  }
  async project(project: Id): Promise<Versioned<wire.Project>> {
    return this.versioned("GET", project_path(project));
  }
  /** `key`: the same for each attempt at one project. */
  async create_project(
    project: { name: string; description: string },
    key: string,
  ): Promise<wire.Project> {
    return this.parsed(
      await this.request("POST", "/projects", project, { "Idempotency-Key": key }),
    );
  }
  async change_project(
    project: Id,
    change: wire.ProjectPatch,
    etag: string,
  ): Promise<wire.Project> {
    return (await this.versioned<wire.Project>("PATCH", project_path(project), change, etag)).value;
  }
  /** Refused while it has models or tables. */
  async delete_project(project: Id): Promise<void> {
    const { etag } = await this.project(project);
    await this.request("DELETE", project_path(project), undefined, { "If-Match": etag });
  }
  /** People with roles of their own there, and groups. */
  async members(project: string): Promise<wire.MemberList> {
    return this.json("GET", `/projects/${encodeURIComponent(project)}/members?limit=1000`);
  }
  async put_member(project: string, user: string, role: wire.ProjectRole): Promise<wire.Member> {
    return this.json("PUT", member_path(project, user), { role });
  }
  async remove_member(project: string, user: string): Promise<void> {
    await this.request("DELETE", member_path(project, user));
  }
  async put_project_group(
    project: string,
    group: number,
    role: wire.ProjectRole,
  ): Promise<wire.MemberGroup> {
    return this.json("PUT", project_group_path(project, group), { role });
  }
  async remove_project_group(project: string, group: number): Promise<void> {
    await this.request("DELETE", project_group_path(project, group));
  }

  /** By name; there are 200 at most. */
  async groups(): Promise<wire.Group[]> {
    return this.all("/groups", "groups");
  }
  async group(id: number): Promise<wire.GroupDetail> {
    return this.json("GET", `/groups/${id}`);
  }
  async create_group(group: wire.GroupCreate): Promise<wire.GroupDetail> {
    return this.json("POST", "/groups", group);
  }
  async change_group(id: number, change: wire.GroupPatch): Promise<wire.GroupDetail> {
    return this.json("PATCH", `/groups/${id}`, change);
  }
  /** With the roles that it has. */
  async delete_group(id: number): Promise<void> {
    await this.request("DELETE", `/groups/${id}`);
  }

  async models(): Promise<Model[]> {
    return this.all("/models", "models");
  }
  async model(id: Id): Promise<Versioned<Model>> {
    return this.versioned("GET", `/models/${encodeURIComponent(id)}`);
  }
  async change_model(id: Id, change: ModelPatch, etag: string): Promise<Versioned<Model>> {
    return this.versioned("PATCH", `/models/${encodeURIComponent(id)}`, change, etag);
  }
  async delete_model(id: Id): Promise<void> {
    const { etag } = await this.model(id);
    await this.request("DELETE", `/models/${encodeURIComponent(id)}`, undefined, {
      "If-Match": etag,
    });
  }

  /**
   * A mesh as the raw body, or with its companions as a form; with progress (0…1 of the bytes
   * sent). `project`: id or slug.
   */
  /**
   * What the file does not say of its unit and up direction is taken as the server proposes it,
   * until somebody confirms it.
   */
  upload_model(
    files: readonly UploadFile[],
    name: string,
    project: string,
    progress: (share: number) => void,
  ): Upload<Job> {
    const { file } = files[0]!;
    const query = new URLSearchParams({
      name,
      filename: file.name,
      project,
      unit: "proposed",
      up: "proposed",
    });
    return this.upload("POST", `/models?${query}`, files, progress);
  }

  async job(id: Id): Promise<Job> {
    return this.json("GET", `/jobs/${encodeURIComponent(id)}`);
  }
  async cancel_job(id: Id): Promise<void> {
    await this.request("DELETE", `/jobs/${encodeURIComponent(id)}`);
  }

  async layers(model: Id): Promise<Layer[]> {
    return (
      await this.all<wire.Layer>(`/models/${encodeURIComponent(model)}/layers`, "layers")
    ).map(complete_layer);
  }
  async create_layer(model: Id, layer: LayerCreate): Promise<Layer> {
    return complete_layer(
      await this.json<wire.Layer>("POST", `/models/${encodeURIComponent(model)}/layers`, layer),
    );
  }
  /** With `compute`: the layer is there once the job is done. */
  async compute_layer(model: Id, layer: LayerCreate): Promise<Job> {
    return this.json("POST", `/models/${encodeURIComponent(model)}/layers`, layer);
  }
  /**
   * With `expression`: the layer, or a job where the surface's shape has to be worked out first.
   */
  async create_computed(model: Id, layer: LayerCreate): Promise<{ layer: Layer } | { job: Job }> {
    const answer = await this.json<wire.Layer | Job>(
      "POST",
      `/models/${encodeURIComponent(model)}/layers`,
      layer,
    );
    return "slug" in answer ? { layer: complete_layer(answer) } : { job: answer };
  }
  async transfer(model: Id, wish: Transfer): Promise<Job> {
    return this.json("POST", `/models/${encodeURIComponent(model)}/transfer`, wish);
  }
  async vertex_properties(model: Id): Promise<VertexPropertyName[]> {
    const path = `/models/${encodeURIComponent(model)}/vertex-properties`;
    return (await this.json<wire.VertexPropertyList>("GET", path)).properties;
  }
  async layer(model: Id, layer: Id): Promise<Versioned<Layer>> {
    const { value, etag } = await this.versioned<wire.Layer>("GET", layer_path(model, layer));
    return { value: complete_layer(value), etag };
  }
  /**
   * With the version that the change was thought out for: another's change in between is an
   * ApiError of status 412. Without, the change stands on its own, and goes onto whatever the layer
   * is now.
   */
  async change_layer(model: Id, layer: Id, change: LayerPatch, etag?: string): Promise<Layer> {
    const version = etag ?? (await this.layer(model, layer)).etag;
    return complete_layer(
      (await this.versioned<wire.Layer>("PATCH", layer_path(model, layer), change, version)).value,
    );
  }
  /** The layer of an expression, from what it reads as it is now. */
  async recompute_layer(model: Id, layer: Id, overwrite = false): Promise<Layer> {
    return complete_layer(
      await this.json<wire.Layer>(
        "POST",
        `${layer_path(model, layer)}/compute${overwrite ? "?overwrite=true" : ""}`,
      ),
    );
  }
  /** How much of the surface a condition holds for. */
  async select(model: Id, where: string): Promise<wire.SelectResponse> {
    return this.json("POST", `/models/${encodeURIComponent(model)}/select`, { where });
  }
  async delete_layer(model: Id, layer: Id): Promise<void> {
    const { etag } = await this.layer(model, layer);
    await this.request("DELETE", layer_path(model, layer), undefined, { "If-Match": etag });
  }
  async looks(model: Id): Promise<wire.Look[]> {
    return this.all(`/models/${encodeURIComponent(model)}/looks`, "looks");
  }
  /** A picture on the model's texture coordinates, named as its file. */
  async create_look(model: Id, file: File): Promise<wire.Look> {
    const query = new URLSearchParams({ name: name_of_file(file.name) });
    const response = await this.request_raw(
      "POST",
      `/models/${encodeURIComponent(model)}/looks?${query}`,
      file,
      {
        "Content-Type": file.type || "application/octet-stream",
      },
    );
    return this.parsed<wire.Look>(response);
  }
  async change_look(model: Id, look: Id, change: wire.LookPatch): Promise<wire.Look> {
    const path = look_path(model, look);
    const { etag } = await this.versioned<wire.Look>("GET", path);
    return (await this.versioned<wire.Look>("PATCH", path, change, etag)).value;
  }
  async delete_look(model: Id, look: Id): Promise<void> {
    await this.delete_as_is(look_path(model, look));
  }
  /** What was done in a project, newest first; `before`: `next` of the page before. */
  async activity(
    project: Id,
    { model, before, limit }: { model: Id | undefined; before: string | undefined; limit: number },
  ): Promise<wire.ActivityList> {
    const query = new URLSearchParams({ limit: `${limit}` });
    if (model !== undefined) query.set("model", `${model}`);
    if (before !== undefined) query.set("before", before);
    return this.json("GET", `${project_path(project)}/activity?${query}`);
  }
  /** What was deleted in a project and can be restored, newest first. */
  async bin(
    project: Id,
    { limit, offset }: { limit: number; offset: number },
  ): Promise<wire.BinList> {
    return this.json("GET", `${project_path(project)}/bin?limit=${limit}&offset=${offset}`);
  }
  async restore_from_bin(project: Id, entry: string): Promise<wire.BinRestored> {
    return this.json("POST", `${project_path(project)}/bin/${encodeURIComponent(entry)}/restore`);
  }
  async erase_from_bin(project: Id, entry: string): Promise<void> {
    await this.request("DELETE", `${project_path(project)}/bin/${encodeURIComponent(entry)}`);
  }
  /** Who sees the project, by name. */
  async project_people(project: Id): Promise<wire.ProjectPerson[]> {
    return this.all(`${project_path(project)}/people`, "people");
  }
  /** Of a model, with replies, by id. */
  async comments(model: Id): Promise<wire.Comment[]> {
    return this.all(`/models/${encodeURIComponent(model)}/comments`, "comments");
  }
  async comment(id: number): Promise<wire.Comment> {
    return this.json("GET", comment_path(id));
  }
  /** Sent again with the same key it is not written twice. */
  async create_comment(model: Id, comment: wire.CommentCreate, key: string): Promise<wire.Comment> {
    return this.parsed(
      await this.request("POST", `/models/${encodeURIComponent(model)}/comments`, comment, {
        "Idempotency-Key": key,
      }),
    );
  }
  async create_reply(thread: number, text: string, key: string): Promise<wire.Comment> {
    return this.parsed(
      await this.request(
        "POST",
        `${comment_path(thread)}/replies`,
        { text },
        { "Idempotency-Key": key },
      ),
    );
  }
  /** With the version that was read: another's change in between is an ApiError of status 412. */
  async change_comment(
    id: number,
    change: wire.CommentPatch,
    version: number,
  ): Promise<wire.Comment> {
    return (await this.versioned<wire.Comment>("PATCH", comment_path(id), change, etag_of(version)))
      .value;
  }
  async delete_comment(id: number, version: number): Promise<void> {
    await this.request("DELETE", comment_path(id), undefined, { "If-Match": etag_of(version) });
  }

  /** All named views of a model. */
  /** What of the layer waits for review, of one person or (null) of all, the oldest first. */
  async review_queue(
    model: Id,
    layer: Id,
    limit: number,
    user: string | null,
  ): Promise<wire.ReviewQueue> {
    const of = user === null ? "" : `&user=${encodeURIComponent(user)}`;
    return this.json("GET", `${layer_path(model, layer)}/review?limit=${limit}${of}`);
  }
  async review(model: Id, layer: Id, decision: wire.Review): Promise<wire.EditResult> {
    return this.json("POST", `${layer_path(model, layer)}/review`, decision);
  }
  async views(model: Id): Promise<wire.View[]> {
    return this.all(views_path(model), "views");
  }
  async view(model: Id, view: Id): Promise<wire.View> {
    return this.json("GET", view_path(model, view));
  }
  /** What it shows now; no side of the picture is longer than `side` pixels. */
  async view_picture(model: Id, view: Id, side: number, signal: AbortSignal): Promise<Blob> {
    return this.blob(
      "GET",
      `${view_path(model, view)}/picture?thumbnail=${side}`,
      undefined,
      signal,
    );
  }
  /** `key`: the same for each attempt at one view. */
  async create_view(model: Id, view: wire.ViewCreate, key: string): Promise<wire.View> {
    return this.parsed(
      await this.request("POST", views_path(model), view, { "Idempotency-Key": key }),
    );
  }
  /** Where nobody changed it since `version`. */
  async change_view(
    model: Id,
    view: Id,
    change: wire.ViewPatch,
    version: number,
  ): Promise<wire.View> {
    return (
      await this.versioned<wire.View>("PATCH", view_path(model, view), change, etag_of(version))
    ).value;
  }
  async delete_view(model: Id, view: Id, version: number): Promise<void> {
    await this.request("DELETE", view_path(model, view), undefined, {
      "If-Match": etag_of(version),
    });
  }
  /** Of a screen that shows a tour; sets its cookie. */
  async sign_in_kiosk(link: string): Promise<wire.KioskSelf> {
    return this.json("POST", "/auth/kiosk", { link });
  }
  async kiosk_self(): Promise<wire.KioskSelf> {
    return this.json("GET", "/kiosk");
  }

  /** All tours of a model. */
  async tours(model: Id): Promise<wire.TourEntry[]> {
    return this.all(tours_path(model), "tours");
  }
  async tour(model: Id, tour: Id): Promise<wire.Tour> {
    return this.json("GET", tour_path(model, tour));
  }
  /** `key`: the same for each attempt at one tour. */
  async create_tour(model: Id, tour: wire.TourCreate, key: string): Promise<wire.Tour> {
    return this.parsed(
      await this.request("POST", tours_path(model), tour, { "Idempotency-Key": key }),
    );
  }
  /** Where nobody changed it since `version`. */
  async change_tour(
    model: Id,
    tour: Id,
    change: wire.TourPatch,
    version: number,
  ): Promise<wire.Tour> {
    return (
      await this.versioned<wire.Tour>("PATCH", tour_path(model, tour), change, etag_of(version))
    ).value;
  }
  /** With its links for kiosks. */
  async delete_tour(model: Id, tour: Id, version: number): Promise<void> {
    await this.request("DELETE", tour_path(model, tour), undefined, {
      "If-Match": etag_of(version),
    });
  }
  /** Those that this person may see to: administrators all, curators those of their projects. */
  async kiosks(): Promise<wire.Kiosk[]> {
    return this.all("/kiosks", "kiosks");
  }
  /** The link is told this once. */
  async create_kiosk(model: Id, tour: Id, kiosk: wire.KioskCreate): Promise<wire.KioskMade> {
    return this.json("POST", `${tour_path(model, tour)}/kiosks`, kiosk);
  }
  async revoke_kiosk(kiosk: number): Promise<void> {
    await this.request("DELETE", kiosk_path(kiosk));
  }
  /** Asks it to load its page anew, at its next heartbeat. */
  async reload_kiosk(kiosk: number): Promise<wire.Kiosk> {
    return this.json("POST", `${kiosk_path(kiosk)}/reload`);
  }
  async tables(project: Id): Promise<wire.Table[]> {
    return this.all(`${project_path(project)}/tables`, "tables");
  }
  async table(table: Id): Promise<wire.Table> {
    return this.json("GET", table_path(table));
  }
  /**
   * With its records and their history. Refused while a layer, or a column of another table, names
   * it.
   */
  async delete_table(table: Id): Promise<void> {
    const { etag } = await this.versioned<wire.Table>("GET", table_path(table));
    await this.request("DELETE", table_path(table), undefined, { "If-Match": etag });
  }
  /** The column that says what a record is called, by its id; null: the best one by rule. */
  async set_title_column(table: Id, column: number | null): Promise<wire.Table> {
    return this.change_as_is(table_path(table), {
      title_column: column === null ? "" : `${column}`,
    });
  }
  async create_column(table: Id, column: wire.ColumnCreate): Promise<wire.ColumnChanged> {
    return this.json("POST", `${table_path(table)}/columns`, column);
  }
  async change_column(
    table: Id,
    column: Id,
    change: wire.ColumnPatch,
  ): Promise<wire.ColumnChanged> {
    return this.change_as_is(column_path(table, column), change);
  }
  async drop_column(table: Id, column: Id): Promise<void> {
    await this.delete_as_is(column_path(table, column));
  }
  /** Of the caller's changes of columns and records, the newest. */
  async undo_table(table: Id): Promise<wire.TableChanged> {
    return this.json("POST", `${table_path(table)}/undo`);
  }
  async redo_table(table: Id): Promise<wire.TableChanged> {
    return this.json("POST", `${table_path(table)}/redo`);
  }
  /** Newest first. */
  async table_edits(table: Id, limit: number): Promise<wire.TableEdit[]> {
    return (
      await this.json<wire.TableEditList>(
        "GET",
        `${table_path(table)}/edits?${new URLSearchParams({ limit: `${limit}` })}`,
      )
    ).edits;
  }
  /** Of one record, newest first. */
  async record_edits(table: Id, key: number, limit: number): Promise<wire.TableEdit[]> {
    return (
      await this.json<wire.TableEditList>(
        "GET",
        `${table_path(table)}/edits?${new URLSearchParams({ key: `${key}`, limit: `${limit}` })}`,
      )
    ).edits;
  }
  /** A page of a table's records; of a layer's, with their areas there. */
  async records(
    place: RecordPlace,
    { sortby = "", filter = "", limit, offset }: RecordQuery,
  ): Promise<wire.RecordList> {
    const query = new URLSearchParams({ limit: `${limit}`, offset: `${offset}` });
    if (sortby !== "") query.set("sortby", sortby);
    // in whose alphabet
    if (sortby !== "" && sortby !== "key" && sortby !== "-key")
      query.set("lang", person_languages()[0]!);
    if (filter !== "") query.set("filter", filter);
    return this.json("GET", `${records_path(place)}?${query}`);
  }
  async record(place: RecordPlace, key: number): Promise<wire.TableRecord> {
    return this.json("GET", `${records_path(place)}/${key}`);
  }
  /** Without a key it gets the next one. */
  async create_record(table: Id, record: wire.RecordInput = {}): Promise<wire.TableRecord> {
    return this.json("POST", records_path({ table }), { values: {}, ...record });
  }
  /** With the version that was read: another's change in between is an ApiError of status 412. */
  async change_record(table: Id, key: number, change: wire.RecordPatch): Promise<wire.TableRecord> {
    const path = `${records_path({ table })}/${key}`;
    if (change.version === undefined) return this.change_as_is(path, change);
    return (await this.versioned<wire.TableRecord>("PATCH", path, change, etag_of(change.version)))
      .value;
  }
  /** `texels`: what becomes of the surface that has the record's key. */
  async delete_record(table: Id, key: number, texels: TexelsOfDeleted): Promise<void> {
    const query = new URLSearchParams({
      texels: texels.what,
      ...(texels.what === "reassign" ? { to: `${texels.to}` } : {}),
    });
    const path = `${records_path({ table })}/${key}`;
    await this.delete_as_is(`${path}?${query}`);
  }
  /** Files of a record. */
  async attachments(table: Id, key: number): Promise<wire.Attachment[]> {
    return (
      await this.json<wire.AttachmentList>("GET", `${records_path({ table })}/${key}/attachments`)
    ).attachments;
  }
  /** Where a file is had, or a small JPEG of a picture, of at most so many pixels a side. */
  attachment_url(id: number, thumbnail?: 64 | 128 | 256 | 512 | 1024): string {
    return `${kBase}/attachments/${id}${thumbnail ? `?thumbnail=${thumbnail}` : ""}`;
  }
  async attach(table: Id, key: number, column: string, file: File): Promise<void> {
    const query = new URLSearchParams({ name: file.name, column });
    await this.request_raw("POST", `${records_path({ table })}/${key}/attachments?${query}`, file, {
      "Content-Type": "application/octet-stream",
    });
  }
  async show_attachment(id: number, visibility: wire.Visibility): Promise<wire.Attachment> {
    return this.json("PATCH", `/attachments/${id}`, { visibility });
  }
  /** Which records files are of, by their names. */
  async match_attachments(table: Id, match: wire.AttachmentMatch): Promise<wire.AttachmentMatches> {
    return this.json("POST", `${table_path(table)}/attachments/match`, match);
  }
  /** Where records are had as CSV. */
  records_url(place: RecordPlace, query: Record<string, string>): string {
    return `${kBase}${records_path(place)}?${new URLSearchParams({ f: "csv", ...query })}`;
  }
  /** `dry_run` only reports. Where rows are wrong nothing is written. */
  async import_records(table: Id, csv: Blob, dry_run: boolean): Promise<wire.RecordsReport> {
    const path = `${records_path({ table })}${dry_run ? "?dry_run=true" : ""}`;
    return this.parsed(await this.request_raw("POST", path, csv, { "Content-Type": "text/csv" }));
  }
  /**
   * Terms of a list as a tree that is written down; with `q` those that have its words, and those
   * above them.
   */
  async terms(table: Id, { q = "", lang, limit, offset }: TermQuery): Promise<wire.TermTree> {
    const query = new URLSearchParams({
      lang,
      limit: `${limit}`,
      offset: `${offset}`,
      ...(q === "" ? {} : { q }),
    });
    return this.json("GET", `${table_path(table)}/terms?${query}`);
  }
  /** Where a list of terms is had as a file that may be imported elsewhere. */
  terms_url(table: Id, format: "csv" | "turtle"): string {
    return `${kBase}${table_path(table)}/terms?f=${format}`;
  }
  /**
   * A new list of the project, or more terms for one. `dry_run` only reports. Where terms are wrong
   * nothing is written.
   */
  async import_terms(
    into: { project: Id; name: string } | { table: Id },
    file: Blob,
    type: TermsType,
    dry_run: boolean,
  ): Promise<wire.RecordsReport> {
    const query = new URLSearchParams({
      ...("name" in into ? { name: into.name } : {}),
      ...(dry_run ? { dry_run: "true" } : {}),
    });
    const place = "table" in into ? table_path(into.table) : project_path(into.project);
    return this.parsed(
      await this.request_raw("POST", `${place}/terms?${query}`, file, { "Content-Type": type }),
    );
  }
  async templates(): Promise<wire.Template[]> {
    return this.all("/templates", "templates");
  }
  /** Makes its tables, and its layers on the model. */
  async use_template(project: Id, template: Id, use: wire.TemplateUse): Promise<TemplateMade> {
    const made = await this.json<wire.TemplateMade>(
      "POST",
      `${project_path(project)}/templates/${encodeURIComponent(template)}`,
      use,
    );
    return { tables: made.tables, layers: made.layers.map(complete_layer) };
  }
  async has_record(table: Id, key: number): Promise<boolean> {
    try {
      await this.request("GET", `/tables/${encodeURIComponent(table)}/records/${key}`);
      return true;
    } catch (error) {
      if (error instanceof ApiError && error.status === 404) return false;
      throw error;
    }
  }
  async tools(): Promise<wire.Tool[]> {
    return this.all("/tools", "tools");
  }
  async create_tool(picture: Blob, name: string, part: string): Promise<wire.Tool> {
    const query = new URLSearchParams({ name, part });
    const response = await this.request_raw("POST", `/tools?${query}`, picture, {
      "Content-Type": picture.type,
    });
    return this.parsed<wire.Tool>(response);
  }
  async rename_tool(tool: Id, name: string): Promise<wire.Tool> {
    return this.json("PATCH", `/tools/${encodeURIComponent(tool)}`, { name });
  }
  async delete_tool(tool: Id): Promise<void> {
    await this.request("DELETE", `/tools/${encodeURIComponent(tool)}`);
  }
  /** Where records of the layer lie, and how much surface they have. */
  async extent(model: Id, layer: Id, highlight: wire.Highlight): Promise<wire.Extent> {
    return this.json("POST", `${layer_path(model, layer)}/extent`, highlight);
  }
  /** What a column holds, in classes; without a count the server's own. */
  async classes(
    table: Id,
    column: Id,
    method: "equal" | "quantile" | "unique",
    count?: number,
  ): Promise<wire.ColumnClasses> {
    const query = new URLSearchParams({
      method,
      ...(count === undefined ? {} : { count: `${count}` }),
    });
    return this.json(
      "GET",
      `${table_path(table)}/columns/${encodeURIComponent(column)}/classes?${query}`,
    );
  }
  /** What a camera sees at a pixel of its window. */
  async pick(
    model: Id,
    camera: CameraMessage,
    [x, y]: readonly [number, number],
  ): Promise<wire.SurfacePoint> {
    return this.json("POST", `/models/${encodeURIComponent(model)}/pick`, { camera, x, y });
  }
  /** What it sees along a path of its window's pixels, at each of them. */
  async profile(
    model: Id,
    camera: CameraMessage,
    path: readonly (readonly [number, number])[],
  ): Promise<wire.Profile> {
    return this.profile_of(model, { camera, path, layers: [] });
  }
  /** The same, or through places; also as the CSV file that the server makes of it. */
  async profile_of(model: Id, line: ProfileLine): Promise<wire.Profile> {
    return this.json("POST", `/models/${encodeURIComponent(model)}/profile`, line);
  }
  async profile_csv(model: Id, line: ProfileLine): Promise<Blob> {
    return (
      await this.request("POST", `/models/${encodeURIComponent(model)}/profile`, line, {
        Accept: "text/csv",
      })
    ).blob();
  }
  async statistics(model: Id, layer: Id): Promise<Statistics> {
    return this.json("GET", `${layer_path(model, layer)}/statistics`);
  }
  /** Where the areas of a layer's classes are had as a sheet. */
  quantities_url(model: Id, layer: Id, query: SheetQuery): string {
    return `${kBase}${layer_path(model, layer)}/quantities?${new URLSearchParams({ ...query })}`;
  }
  /**
   * Where outlines of a layer's classes, and lines and points of its records, are had for maps;
   * `along`: the way that the map is looked at.
   */
  features_url(model: Id, layer: Id, query: { f: string; along: string; lang: string }): string {
    return `${kBase}${layer_path(model, layer)}/features?${new URLSearchParams({ ...query })}`;
  }
  /** Areas where two layers meet: layers of whole numbers or keys. */
  async cross_table(model: Id, rows: Id, columns: Id): Promise<wire.CrossTable> {
    return this.json("POST", `/models/${encodeURIComponent(model)}/cross-table`, { rows, columns });
  }
  async cross_table_sheet(model: Id, rows: Id, columns: Id, query: SheetQuery): Promise<Blob> {
    const path = `/models/${encodeURIComponent(model)}/cross-table?${new URLSearchParams({ ...query })}`;
    return (await this.request("POST", path, { rows, columns }, kAnyFile)).blob();
  }

  /** Answered once it is durable. */
  async edit(model: Id, layer: Id, edit: wire.Edit): Promise<wire.EditResult> {
    return this.json("POST", `${layer_path(model, layer)}/edits`, edit);
  }

  /** Where a layer's texels are had as a file. */
  texels_url(model: Id, layer: Id, format: string): string {
    return `${kBase}${layer_path(model, layer)}/texels.${format}`;
  }
  /** The layer then holds what the file does. Answered once it is durable. */
  async put_texels(model: Id, layer: Id, format: string, file: Blob): Promise<wire.EditResult> {
    const path = `${layer_path(model, layer)}/texels.${format}`;
    const response = await this.request_raw("PUT", path, file, {
      ...kFile,
      "Idempotency-Key": new_id(),
    });
    return (await response.json()) as wire.EditResult;
  }

  /** Paints files over the layer. Answered once it is durable. */
  paint_map(
    model: Id,
    layer: Id,
    kind: "readings" | "polygons" | "picture",
    query: Record<string, string>,
    files: readonly UploadFile[],
    progress: Progress,
  ): Upload<wire.EditResult> {
    const path = `${layer_path(model, layer)}/${kind}?${new URLSearchParams(query)}`;
    // the names of maps tell what they are
    return this.upload("POST", path, files, progress, kind !== "readings");
  }
  /**
   * One number a line for each vertex of a scan; `source` where the model has several. Answered
   * once it is durable.
   */
  put_vertex_values(
    model: Id,
    layer: Id,
    source: string | null,
    file: UploadFile,
    progress: Progress,
  ): Upload<wire.EditResult> {
    const query = source === null ? "" : `?${new URLSearchParams({ source })}`;
    return this.upload("PUT", `${layer_path(model, layer)}/vertices.csv${query}`, [file], progress);
  }
  /** What a map's files hold. */
  map_contents(
    model: Id,
    query: Record<string, string>,
    files: readonly UploadFile[],
    progress: Progress,
  ): Upload<wire.MapContents> {
    const path = `/models/${encodeURIComponent(model)}/map-contents?${new URLSearchParams(query)}`;
    return this.upload("POST", path, files, progress, true);
  }
  /** Makes a look of an orthophoto. */
  add_orthophoto(
    model: Id,
    query: Record<string, string>,
    files: readonly UploadFile[],
    progress: Progress,
  ): Upload<Job> {
    const path = `/models/${encodeURIComponent(model)}/orthophotos?${new URLSearchParams(query)}`;
    return this.upload("POST", path, files, progress, true);
  }

  async frame(model: Id, camera: CameraMessage, signal: AbortSignal): Promise<Blob> {
    return this.blob(
      "POST",
      `/models/${encodeURIComponent(model)}/frame`,
      { camera, format: "jpeg" },
      signal,
    );
  }

  /** A job whose file it is. */
  async make_figure(model: Id, figure: wire.FigureRequest): Promise<Job> {
    return this.parsed(
      await this.request("POST", figures_path(model), figure, { Prefer: "respond-async" }),
    );
  }
  /** The file itself, for small ones. */
  async figure(model: Id, figure: wire.FigureRequest, signal: AbortSignal): Promise<Blob> {
    return this.blob("POST", figures_path(model), figure, signal);
  }
  /** What a job of this person made. */
  async job_file(id: Id): Promise<Blob> {
    return (
      await this.request("GET", `/jobs/${encodeURIComponent(id)}/file`, undefined, kAnyFile)
    ).blob();
  }

  /** As a form, or the only file as the body; `fetch` does not tell how much is sent. */
  private upload<T>(
    method: string,
    path: string,
    files: readonly UploadFile[],
    progress: Progress,
    as_form = files.length > 1,
  ): Upload<T> {
    const form = new FormData();
    if (as_form) for (const each of files) form.append("files", each.file, each.path);
    const request = this.make_request_();
    const done = new Promise<T>((resolve, reject) => {
      request.open(method, kBase + path);
      if (!as_form) request.setRequestHeader("Content-Type", "application/octet-stream");
      request.setRequestHeader("Idempotency-Key", new_id());
      request.upload.onprogress = (event) => {
        if (event.lengthComputable) progress(event.loaded / event.total);
      };
      request.onload = () => {
        if (request.status >= 400) {
          reject(new ApiError(problem_of_text(request.status, request.responseText)));
          return;
        }
        try {
          resolve(JSON.parse(request.responseText) as T);
        } catch {
          reject(new ApiError(problem_of_text(502, "")));
        }
      };
      request.onerror = () => reject(unreachable());
      request.onabort = () => reject(cancelled());
      request.send(as_form ? form : files[0]!.file);
    });
    return { done, cancel: () => request.abort() };
  }

  /**
   * Every entry of a list, page by page: each begins where the one before ended, whatever others
   * write meanwhile.
   */
  private async all<T>(path: string, list: string): Promise<T[]> {
    const found: T[] = [];
    for (let next: string | null = `${path}?limit=1000`; next !== null;) {
      const response: Response = await this.request("GET", next);
      found.push(...(await this.parsed<Record<string, T[]>>(response))[list]!);
      next = next_page(response.headers.get("Link"));
    }
    return found;
  }

  /** A change that stands on its own, of whatever is there now. */
  private async change_as_is<T>(path: string, change: unknown): Promise<T> {
    return (await this.versioned<T>("PATCH", path, change, "*")).value;
  }
  private async delete_as_is(path: string): Promise<void> {
    await this.request("DELETE", path, undefined, { "If-Match": "*" });
  }

  private async json<T>(method: string, path: string, body?: unknown): Promise<T> {
    return (await this.versioned<T>(method, path, body)).value;
  }

  private async versioned<T>(
    method: string,
    path: string,
    body?: unknown,
    etag?: string,
  ): Promise<Versioned<T>> {
    const response = await this.request(method, path, body, etag ? { "If-Match": etag } : {});
    return { value: await this.parsed<T>(response), etag: response.headers.get("ETag") ?? "" };
  }

  private async parsed<T>(response: Response): Promise<T> {
    try {
      return (await response.json()) as T;
    } catch {
      throw new ApiError(problem_of_text(502, ""));
    }
  }

  /** A file whose request may be given up, also while it comes. */
  private async blob(
    method: string,
    path: string,
    body: unknown,
    signal: AbortSignal,
  ): Promise<Blob> {
    const response = await this.request(method, path, body, kAnyFile, signal);
    try {
      return await response.blob();
    } catch {
      throw signal.aborted ? cancelled() : unreachable();
    }
  }

  private async request(
    method: string,
    path: string,
    body?: unknown,
    headers: Record<string, string> = {},
    signal?: AbortSignal,
  ): Promise<Response> {
    if (body === undefined) return this.request_raw(method, path, null, headers, signal);
    return this.request_raw(
      method,
      path,
      JSON.stringify(body),
      { "Content-Type": "application/json", ...headers },
      signal,
    );
  }

  private async request_raw(
    method: string,
    path: string,
    body: BodyInit | null,
    headers: Record<string, string> = {},
    signal?: AbortSignal,
    keepalive = false,
  ): Promise<Response> {
    const all: Record<string, string> = { Accept: "application/json", ...headers };
    if (method === "POST" && !kWithSecrets.test(path)) all["Idempotency-Key"] ??= new_id();
    let response: Response;
    try {
      response = await this.fetch_(kBase + path, {
        method,
        headers: all,
        credentials: "same-origin",
        ...(body === null ? {} : { body }),
        ...(signal ? { signal } : {}),
        ...(keepalive ? { keepalive } : {}),
      });
    } catch {
      throw signal?.aborted ? cancelled() : unreachable();
    }
    if (!response.ok)
      throw new ApiError(problem_of_text(response.status, await response.text().catch(() => "")));
    return response;
  }
}

const kMostKeptAlive = 60_000; // characters of a body that browsers send after its page

/**
 * What is sent or answered there is not for the server to keep, as it does for an
 * `Idempotency-Key`.
 */
const kWithSecrets =
  /^\/(login|auth\/.+|invitations\/.+|me\/.+|users|users\/.+|models\/[^/]+\/tours\/[^/]+\/kiosks)$/;

const kFile = { "Content-Type": "application/octet-stream" };
/** A read that takes JSON alone is refused where a file of another kind would answer it. */
const kAnyFile = { Accept: "*/*" };

const layer_path = (model: Id, layer: Id): string =>
  `/models/${encodeURIComponent(model)}/layers/${encodeURIComponent(layer)}`;

const person_path = (user: string): string => `/users/${encodeURIComponent(user)}`;
const project_group_path = (project: string, group: number): string =>
  `/projects/${encodeURIComponent(project)}/groups/${group}`;
const member_path = (project: string, user: string): string =>
  `/projects/${encodeURIComponent(project)}/members/${encodeURIComponent(user)}`;

const project_path = (project: Id): string => `/projects/${encodeURIComponent(project)}`;

const table_path = (table: Id): string => `/tables/${encodeURIComponent(table)}`;

const column_path = (table: Id, column: Id): string =>
  `${table_path(table)}/columns/${encodeURIComponent(column)}`;

const records_path = (place: RecordPlace): string =>
  `${"table" in place ? table_path(place.table) : layer_path(place.model, place.layer)}/records`;

const comment_path = (id: number): string => `/comments/${id}`;

const figures_path = (model: Id): string =>
  `/models/${encodeURIComponent(model)}/figures?${new URLSearchParams({ lang: page_locale() })}`;

const views_path = (model: Id): string => `/models/${encodeURIComponent(model)}/views`;
const view_path = (model: Id, view: Id): string =>
  `${views_path(model)}/${encodeURIComponent(view)}`;

const tours_path = (model: Id): string => `/models/${encodeURIComponent(model)}/tours`;
const tour_path = (model: Id, tour: Id): string =>
  `${tours_path(model)}/${encodeURIComponent(tour)}`;
const kiosk_path = (kiosk: number): string => `/kiosks/${kiosk}`;

const etag_of = (version: number): string => `"v${version}"`;

const look_path = (model: Id, look: Id): string =>
  `/models/${encodeURIComponent(model)}/looks/${encodeURIComponent(look)}`;

const cancelled = (): ApiError => new ApiError({ status: 499, title: "Cancelled" });

function unreachable(): ApiError {
  const [title, detail] = own_problems().unreachable;
  return new ApiError({ status: 0, title, detail });
}

/**
 * Where the next page of a list is, below `kBase`, by the `Link` of this one (RFC 8288); null: it
 * is the last.
 */
export function next_page(link: string | null): string | null {
  const target = /<([^>]*)>\s*;\s*rel="?next"?/.exec(link ?? "")?.[1];
  return target?.startsWith(kBase) ? target.slice(kBase.length) : null;
}

/**
 * The problem in an answer's text; where the text is not one, what the status means in plain words.
 */
export function problem_of_text(status: number, text: string): ProblemBody {
  try {
    const body = JSON.parse(text) as Partial<ProblemBody> | null;
    if (body && typeof body.title === "string") {
      return {
        status: typeof body.status === "number" ? body.status : status,
        title: body.title,
        ...(body.detail ? { detail: String(body.detail) } : {}),
        ...(body.field ? { field: String(body.field) } : {}),
        ...(typeof body.offset === "number" ? { offset: body.offset } : {}),
        ...(body.rows ? { rows: body.rows } : {}),
      };
    }
  } catch {
    // Not JSON: a proxy's page, or nothing. The status says enough.
  }
  const words = own_problems();
  const [title, detail] = words.statuses[status] ?? [
    words.other_status(status),
    words.other_status_detail,
  ];
  return { status, title, detail };
}

/** A model's name from its file's: "statue_nefertiti_70k.ply" → "statue nefertiti 70k". */
export function name_of_file(filename: string): string {
  const stem = filename
    .replace(/\.[a-z0-9]{1,5}$/i, "")
    .replace(/_+/g, " ")
    .trim();
  return stem || filename;
}

/** A random UUID; also on plain-HTTP addresses, where `crypto.randomUUID` is absent. */
export function new_id(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  bytes[6] = (bytes[6]! & 0x0f) | 0x40;
  bytes[8] = (bytes[8]! & 0x3f) | 0x80;
  const hex = [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
  return `${hex.slice(0, 8)}-${hex.slice(8, 12)}-${hex.slice(12, 16)}-${hex.slice(16, 20)}-${hex.slice(20)}`;
}
