// The HTTP interface with typed results. Every failure, also a lost network, becomes an ApiError
// that carries a problem a person can read.

import type { CameraMessage } from "../math/camera";
import { pageLocale, personLanguages } from "../core/locale";
import { ownProblems } from "../core/problems";
import type * as wire from "../core/protocol.gen";
import {
  completeLayer,
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
export interface WorkbookQuery {
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
    private readonly _fetch: Fetch = (input, init) => fetch(input, init),
    private readonly _makeRequest: () => XMLHttpRequest = () => new XMLHttpRequest(),
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
  async changeMe(change: wire.MePatch): Promise<Me> {
    return this.json("PATCH", "/me", change);
  }
  /** How this person shows the layers of a model, for them alone. Goes on when the page is left. */
  async keepPersonalView(model: Id, view: wire.PersonalView): Promise<void> {
    const body = JSON.stringify(view);
    const path = `/me/models/${encodeURIComponent(model)}/view`;
    await this.requestRaw(
      "PUT",
      path,
      body,
      { "Content-Type": "application/json" },
      undefined,
      body.length < kMostKeptAlive,
    );
  }
  /** Ends all other sessions. */
  async changePassword(change: wire.PasswordChange): Promise<void> {
    await this.request("POST", "/me/password", change);
  }
  /** Where this person is signed in, the newest first. */
  async signInSessions(): Promise<wire.SignInSession[]> {
    return this.all("/me/sessions", "sessions");
  }
  async endSession(id: number): Promise<void> {
    await this.request("DELETE", `/me/sessions/${id}`);
  }
  async endOtherSessions(): Promise<void> {
    await this.request("DELETE", "/me/sessions");
  }
  async scriptTokens(): Promise<wire.ScriptToken[]> {
    return this.all("/me/tokens", "tokens");
  }
  async createToken(token: wire.ScriptTokenCreate): Promise<wire.ScriptTokenMade> {
    return this.json("POST", "/me/tokens", token);
  }
  async revokeToken(id: number): Promise<void> {
    await this.request("DELETE", `/me/tokens/${id}`);
  }

  /** Whose invitation it is. */
  async showInvitation(invitation: string): Promise<wire.Person> {
    return this.json("POST", "/invitations/show", { invitation });
  }
  /** Opens a session. */
  async acceptInvitation(accept: wire.InvitationAccept): Promise<Me> {
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
  async inviteAgain(user: string): Promise<wire.Invitation> {
    return this.json("POST", `${personPath(user)}/invite`);
  }
  async changePerson(user: string, change: wire.PersonPatch): Promise<wire.Person> {
    return this.json("PATCH", personPath(user), change);
  }
  async deletePerson(user: string): Promise<void> {
    await this.request("DELETE", personPath(user));
  }

  async projects(): Promise<wire.Project[]> {
    return this.all("/projects", "projects");
  }
  async project(project: Id): Promise<Versioned<wire.Project>> {
    return this.versioned("GET", projectPath(project));
  }
  /** `key`: the same for each attempt at one project. */
  async createProject(
    project: { name: string; description: string },
    key: string,
  ): Promise<wire.Project> {
    return this.parsed(
      await this.request("POST", "/projects", project, { "Idempotency-Key": key }),
    );
  }
  async changeProject(project: Id, change: wire.ProjectPatch, etag: string): Promise<wire.Project> {
    return (await this.versioned<wire.Project>("PATCH", projectPath(project), change, etag)).value;
  }
  /** Refused while it has models or tables. */
  async deleteProject(project: Id): Promise<void> {
    const { etag } = await this.project(project);
    await this.request("DELETE", projectPath(project), undefined, { "If-Match": etag });
  }
  /** People with roles of their own there, and groups. */
  async members(project: string): Promise<wire.MemberList> {
    return this.json("GET", `/projects/${encodeURIComponent(project)}/members?limit=1000`);
  }
  async putMember(project: string, user: string, role: wire.ProjectRole): Promise<wire.Member> {
    return this.json("PUT", memberPath(project, user), { role });
  }
  async removeMember(project: string, user: string): Promise<void> {
    await this.request("DELETE", memberPath(project, user));
  }
  async putProjectGroup(
    project: string,
    group: number,
    role: wire.ProjectRole,
  ): Promise<wire.MemberGroup> {
    return this.json("PUT", projectGroupPath(project, group), { role });
  }
  async removeProjectGroup(project: string, group: number): Promise<void> {
    await this.request("DELETE", projectGroupPath(project, group));
  }

  /** By name; there are 200 at most. */
  async groups(): Promise<wire.Group[]> {
    return this.all("/groups", "groups");
  }
  async group(id: number): Promise<wire.GroupDetail> {
    return this.json("GET", `/groups/${id}`);
  }
  async createGroup(group: wire.GroupCreate): Promise<wire.GroupDetail> {
    return this.json("POST", "/groups", group);
  }
  async changeGroup(id: number, change: wire.GroupPatch): Promise<wire.GroupDetail> {
    return this.json("PATCH", `/groups/${id}`, change);
  }
  /** With the roles that it has. */
  async deleteGroup(id: number): Promise<void> {
    await this.request("DELETE", `/groups/${id}`);
  }

  async models(): Promise<Model[]> {
    return this.all("/models", "models");
  }
  async model(id: Id): Promise<Versioned<Model>> {
    return this.versioned("GET", `/models/${encodeURIComponent(id)}`);
  }
  async changeModel(id: Id, change: ModelPatch, etag: string): Promise<Versioned<Model>> {
    return this.versioned("PATCH", `/models/${encodeURIComponent(id)}`, change, etag);
  }
  async deleteModel(id: Id): Promise<void> {
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
  uploadModel(
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
  async cancelJob(id: Id): Promise<void> {
    await this.request("DELETE", `/jobs/${encodeURIComponent(id)}`);
  }

  async layers(model: Id): Promise<Layer[]> {
    return (
      await this.all<wire.Layer>(`/models/${encodeURIComponent(model)}/layers`, "layers")
    ).map(completeLayer);
  }
  async createLayer(model: Id, layer: LayerCreate): Promise<Layer> {
    return completeLayer(
      await this.json<wire.Layer>("POST", `/models/${encodeURIComponent(model)}/layers`, layer),
    );
  }
  /** With `compute`: the layer is there once the job is done. */
  async computeLayer(model: Id, layer: LayerCreate): Promise<Job> {
    return this.json("POST", `/models/${encodeURIComponent(model)}/layers`, layer);
  }
  /**
   * With `expression`: the layer, or a job where the surface's shape has to be worked out first.
   */
  async createComputed(model: Id, layer: LayerCreate): Promise<{ layer: Layer } | { job: Job }> {
    const answer = await this.json<wire.Layer | Job>(
      "POST",
      `/models/${encodeURIComponent(model)}/layers`,
      layer,
    );
    return "slug" in answer ? { layer: completeLayer(answer) } : { job: answer };
  }
  async transfer(model: Id, wish: Transfer): Promise<Job> {
    return this.json("POST", `/models/${encodeURIComponent(model)}/transfer`, wish);
  }
  async vertexProperties(model: Id): Promise<VertexPropertyName[]> {
    const path = `/models/${encodeURIComponent(model)}/vertex-properties`;
    return (await this.json<wire.VertexPropertyList>("GET", path)).properties;
  }
  async layer(model: Id, layer: Id): Promise<Versioned<Layer>> {
    const { value, etag } = await this.versioned<wire.Layer>("GET", layerPath(model, layer));
    return { value: completeLayer(value), etag };
  }
  /**
   * With the version that the change was thought out for: another's change in between is an
   * ApiError of status 412. Without, the change stands on its own, and goes onto whatever the layer
   * is now.
   */
  async changeLayer(model: Id, layer: Id, change: LayerPatch, etag?: string): Promise<Layer> {
    const version = etag ?? (await this.layer(model, layer)).etag;
    return completeLayer(
      (await this.versioned<wire.Layer>("PATCH", layerPath(model, layer), change, version)).value,
    );
  }
  /** The layer of an expression, from what it reads as it is now. */
  async recomputeLayer(model: Id, layer: Id, overwrite = false): Promise<Layer> {
    return completeLayer(
      await this.json<wire.Layer>(
        "POST",
        `${layerPath(model, layer)}/compute${overwrite ? "?overwrite=true" : ""}`,
      ),
    );
  }
  /** How much of the surface a condition holds for. */
  async select(model: Id, where: string): Promise<wire.SelectResponse> {
    return this.json("POST", `/models/${encodeURIComponent(model)}/select`, { where });
  }
  async deleteLayer(model: Id, layer: Id): Promise<void> {
    const { etag } = await this.layer(model, layer);
    await this.request("DELETE", layerPath(model, layer), undefined, { "If-Match": etag });
  }
  async looks(model: Id): Promise<wire.Look[]> {
    return this.all(`/models/${encodeURIComponent(model)}/looks`, "looks");
  }
  /** A picture on the model's texture coordinates, named as its file. */
  async createLook(model: Id, file: File): Promise<wire.Look> {
    const query = new URLSearchParams({ name: nameOfFile(file.name) });
    const response = await this.requestRaw(
      "POST",
      `/models/${encodeURIComponent(model)}/looks?${query}`,
      file,
      {
        "Content-Type": file.type || "application/octet-stream",
      },
    );
    return this.parsed<wire.Look>(response);
  }
  async changeLook(model: Id, look: Id, change: wire.LookPatch): Promise<wire.Look> {
    const path = lookPath(model, look);
    const { etag } = await this.versioned<wire.Look>("GET", path);
    return (await this.versioned<wire.Look>("PATCH", path, change, etag)).value;
  }
  async deleteLook(model: Id, look: Id): Promise<void> {
    await this.deleteAsIs(lookPath(model, look));
  }
  /** What was done in a project, newest first; `before`: `next` of the page before. */
  async activity(
    project: Id,
    { model, before, limit }: { model: Id | undefined; before: string | undefined; limit: number },
  ): Promise<wire.ActivityList> {
    const query = new URLSearchParams({ limit: `${limit}` });
    if (model !== undefined) query.set("model", `${model}`);
    if (before !== undefined) query.set("before", before);
    return this.json("GET", `${projectPath(project)}/activity?${query}`);
  }
  /** What was deleted in a project and can be restored, newest first. */
  async trash(
    project: Id,
    { limit, offset }: { limit: number; offset: number },
  ): Promise<wire.BinList> {
    return this.json("GET", `${projectPath(project)}/bin?limit=${limit}&offset=${offset}`);
  }
  async restoreFromTrash(project: Id, entry: string): Promise<wire.BinRestored> {
    return this.json("POST", `${projectPath(project)}/bin/${encodeURIComponent(entry)}/restore`);
  }
  async eraseFromTrash(project: Id, entry: string): Promise<void> {
    await this.request("DELETE", `${projectPath(project)}/bin/${encodeURIComponent(entry)}`);
  }
  /** Who sees the project, by name. */
  async projectPeople(project: Id): Promise<wire.ProjectPerson[]> {
    return this.all(`${projectPath(project)}/people`, "people");
  }
  /** Of a model, with replies, by id. */
  async comments(model: Id): Promise<wire.Comment[]> {
    return this.all(`/models/${encodeURIComponent(model)}/comments`, "comments");
  }
  async comment(id: number): Promise<wire.Comment> {
    return this.json("GET", commentPath(id));
  }
  /** Sent again with the same key it is not written twice. */
  async createComment(model: Id, comment: wire.CommentCreate, key: string): Promise<wire.Comment> {
    return this.parsed(
      await this.request("POST", `/models/${encodeURIComponent(model)}/comments`, comment, {
        "Idempotency-Key": key,
      }),
    );
  }
  async createReply(thread: number, text: string, key: string): Promise<wire.Comment> {
    return this.parsed(
      await this.request(
        "POST",
        `${commentPath(thread)}/replies`,
        { text },
        { "Idempotency-Key": key },
      ),
    );
  }
  /** With the version that was read: another's change in between is an ApiError of status 412. */
  async changeComment(
    id: number,
    change: wire.CommentPatch,
    version: number,
  ): Promise<wire.Comment> {
    return (await this.versioned<wire.Comment>("PATCH", commentPath(id), change, etagOf(version)))
      .value;
  }
  async deleteComment(id: number, version: number): Promise<void> {
    await this.request("DELETE", commentPath(id), undefined, { "If-Match": etagOf(version) });
  }

  /** All named views of a model. */
  /** What of the layer waits for review, of one person or (null) of all, the oldest first. */
  async reviewQueue(
    model: Id,
    layer: Id,
    limit: number,
    user: string | null,
  ): Promise<wire.ReviewQueue> {
    const of = user === null ? "" : `&user=${encodeURIComponent(user)}`;
    return this.json("GET", `${layerPath(model, layer)}/review?limit=${limit}${of}`);
  }
  async review(model: Id, layer: Id, decision: wire.Review): Promise<wire.EditResult> {
    return this.json("POST", `${layerPath(model, layer)}/review`, decision);
  }
  async views(model: Id): Promise<wire.View[]> {
    return this.all(viewsPath(model), "views");
  }
  async view(model: Id, view: Id): Promise<wire.View> {
    return this.json("GET", viewPath(model, view));
  }
  /** What it shows now; no side of the picture is longer than `side` pixels. */
  async viewPicture(model: Id, view: Id, side: number, signal: AbortSignal): Promise<Blob> {
    return this.blob(
      "GET",
      `${viewPath(model, view)}/picture?thumbnail=${side}`,
      undefined,
      signal,
    );
  }
  /** `key`: the same for each attempt at one view. */
  async createView(model: Id, view: wire.ViewCreate, key: string): Promise<wire.View> {
    return this.parsed(
      await this.request("POST", viewsPath(model), view, { "Idempotency-Key": key }),
    );
  }
  /** Where nobody changed it since `version`. */
  async changeView(
    model: Id,
    view: Id,
    change: wire.ViewPatch,
    version: number,
  ): Promise<wire.View> {
    return (
      await this.versioned<wire.View>("PATCH", viewPath(model, view), change, etagOf(version))
    ).value;
  }
  async deleteView(model: Id, view: Id, version: number): Promise<void> {
    await this.request("DELETE", viewPath(model, view), undefined, {
      "If-Match": etagOf(version),
    });
  }
  /** Of a screen that shows a tour; sets its cookie. */
  async signInKiosk(link: string): Promise<wire.KioskSelf> {
    return this.json("POST", "/auth/kiosk", { link });
  }
  async kioskSelf(): Promise<wire.KioskSelf> {
    return this.json("GET", "/kiosk");
  }

  /** All tours of a model. */
  async tours(model: Id): Promise<wire.TourEntry[]> {
    return this.all(toursPath(model), "tours");
  }
  async tour(model: Id, tour: Id): Promise<wire.Tour> {
    return this.json("GET", tourPath(model, tour));
  }
  /** `key`: the same for each attempt at one tour. */
  async createTour(model: Id, tour: wire.TourCreate, key: string): Promise<wire.Tour> {
    return this.parsed(
      await this.request("POST", toursPath(model), tour, { "Idempotency-Key": key }),
    );
  }
  /** Where nobody changed it since `version`. */
  async changeTour(
    model: Id,
    tour: Id,
    change: wire.TourPatch,
    version: number,
  ): Promise<wire.Tour> {
    return (
      await this.versioned<wire.Tour>("PATCH", tourPath(model, tour), change, etagOf(version))
    ).value;
  }
  /** With its links for kiosks. */
  async deleteTour(model: Id, tour: Id, version: number): Promise<void> {
    await this.request("DELETE", tourPath(model, tour), undefined, {
      "If-Match": etagOf(version),
    });
  }
  /** Those that this person may see to: administrators all, curators those of their projects. */
  async kiosks(): Promise<wire.Kiosk[]> {
    return this.all("/kiosks", "kiosks");
  }
  /** The link is told this once. */
  async createKiosk(model: Id, tour: Id, kiosk: wire.KioskCreate): Promise<wire.KioskMade> {
    return this.json("POST", `${tourPath(model, tour)}/kiosks`, kiosk);
  }
  async revokeKiosk(kiosk: number): Promise<void> {
    await this.request("DELETE", kioskPath(kiosk));
  }
  /** Asks it to load its page anew, at its next heartbeat. */
  async reloadKiosk(kiosk: number): Promise<wire.Kiosk> {
    return this.json("POST", `${kioskPath(kiosk)}/reload`);
  }
  async tables(project: Id): Promise<wire.Table[]> {
    return this.all(`${projectPath(project)}/tables`, "tables");
  }
  async table(table: Id): Promise<wire.Table> {
    return this.json("GET", tablePath(table));
  }
  /**
   * With its records and their history. Refused while a layer, or a column of another table, names
   * it.
   */
  async deleteTable(table: Id): Promise<void> {
    const { etag } = await this.versioned<wire.Table>("GET", tablePath(table));
    await this.request("DELETE", tablePath(table), undefined, { "If-Match": etag });
  }
  /** The column that says what a record is called, by its id; null: the best one by rule. */
  async setTitleColumn(table: Id, column: number | null): Promise<wire.Table> {
    return this.changeAsIs(tablePath(table), {
      title_column: column === null ? "" : `${column}`,
    });
  }
  async createColumn(table: Id, column: wire.ColumnCreate): Promise<wire.ColumnChanged> {
    return this.json("POST", `${tablePath(table)}/columns`, column);
  }
  async changeColumn(table: Id, column: Id, change: wire.ColumnPatch): Promise<wire.ColumnChanged> {
    return this.changeAsIs(columnPath(table, column), change);
  }
  async dropColumn(table: Id, column: Id): Promise<void> {
    await this.deleteAsIs(columnPath(table, column));
  }
  /** Of the caller's changes of columns and records, the newest. */
  async undoTable(table: Id): Promise<wire.TableChanged> {
    return this.json("POST", `${tablePath(table)}/undo`);
  }
  async redoTable(table: Id): Promise<wire.TableChanged> {
    return this.json("POST", `${tablePath(table)}/redo`);
  }
  /** Newest first. */
  async tableEdits(table: Id, limit: number): Promise<wire.TableEdit[]> {
    return (
      await this.json<wire.TableEditList>(
        "GET",
        `${tablePath(table)}/edits?${new URLSearchParams({ limit: `${limit}` })}`,
      )
    ).edits;
  }
  /** Of one record, newest first. */
  async recordEdits(table: Id, key: number, limit: number): Promise<wire.TableEdit[]> {
    return (
      await this.json<wire.TableEditList>(
        "GET",
        `${tablePath(table)}/edits?${new URLSearchParams({ key: `${key}`, limit: `${limit}` })}`,
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
      query.set("lang", personLanguages()[0]!);
    if (filter !== "") query.set("filter", filter);
    return this.json("GET", `${recordsPath(place)}?${query}`);
  }
  async record(place: RecordPlace, key: number): Promise<wire.TableRecord> {
    return this.json("GET", `${recordsPath(place)}/${key}`);
  }
  /** Without a key it gets the next one. */
  async createRecord(table: Id, record: wire.RecordInput = {}): Promise<wire.TableRecord> {
    return this.json("POST", recordsPath({ table }), { values: {}, ...record });
  }
  /** With the version that was read: another's change in between is an ApiError of status 412. */
  async changeRecord(table: Id, key: number, change: wire.RecordPatch): Promise<wire.TableRecord> {
    const path = `${recordsPath({ table })}/${key}`;
    if (change.version === undefined) return this.changeAsIs(path, change);
    return (await this.versioned<wire.TableRecord>("PATCH", path, change, etagOf(change.version)))
      .value;
  }
  /** `texels`: what becomes of the surface that has the record's key. */
  async deleteRecord(table: Id, key: number, texels: TexelsOfDeleted): Promise<void> {
    const query = new URLSearchParams({
      texels: texels.what,
      ...(texels.what === "reassign" ? { to: `${texels.to}` } : {}),
    });
    const path = `${recordsPath({ table })}/${key}`;
    await this.deleteAsIs(`${path}?${query}`);
  }
  /** Files of a record. */
  async attachments(table: Id, key: number): Promise<wire.Attachment[]> {
    return (
      await this.json<wire.AttachmentList>("GET", `${recordsPath({ table })}/${key}/attachments`)
    ).attachments;
  }
  /** Where a file is had, or a small JPEG of a picture, of at most so many pixels a side. */
  attachmentUrl(id: number, thumbnail?: 64 | 128 | 256 | 512 | 1024): string {
    return `${kBase}/attachments/${id}${thumbnail ? `?thumbnail=${thumbnail}` : ""}`;
  }
  async attach(table: Id, key: number, column: string, file: File): Promise<void> {
    const query = new URLSearchParams({ name: file.name, column });
    await this.requestRaw("POST", `${recordsPath({ table })}/${key}/attachments?${query}`, file, {
      "Content-Type": "application/octet-stream",
    });
  }
  async showAttachment(id: number, visibility: wire.Visibility): Promise<wire.Attachment> {
    return this.json("PATCH", `/attachments/${id}`, { visibility });
  }
  /** Which records files are of, by their names. */
  async matchAttachments(table: Id, match: wire.AttachmentMatch): Promise<wire.AttachmentMatches> {
    return this.json("POST", `${tablePath(table)}/attachments/match`, match);
  }
  /** Where records are had as CSV. */
  recordsUrl(place: RecordPlace, query: Record<string, string>): string {
    return `${kBase}${recordsPath(place)}?${new URLSearchParams({ f: "csv", ...query })}`;
  }
  /** `dry_run` only reports. Where rows are wrong nothing is written. */
  async importRecords(table: Id, csv: Blob, dryRun: boolean): Promise<wire.RecordsReport> {
    const path = `${recordsPath({ table })}${dryRun ? "?dry_run=true" : ""}`;
    return this.parsed(await this.requestRaw("POST", path, csv, { "Content-Type": "text/csv" }));
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
    return this.json("GET", `${tablePath(table)}/terms?${query}`);
  }
  /** Where a list of terms is had as a file that may be imported elsewhere. */
  termsUrl(table: Id, format: "csv" | "turtle"): string {
    return `${kBase}${tablePath(table)}/terms?f=${format}`;
  }
  /**
   * A new list of the project, or more terms for one. `dry_run` only reports. Where terms are wrong
   * nothing is written.
   */
  async importTerms(
    into: { project: Id; name: string } | { table: Id },
    file: Blob,
    type: TermsType,
    dryRun: boolean,
  ): Promise<wire.RecordsReport> {
    const query = new URLSearchParams({
      ...("name" in into ? { name: into.name } : {}),
      ...(dryRun ? { dry_run: "true" } : {}),
    });
    const place = "table" in into ? tablePath(into.table) : projectPath(into.project);
    return this.parsed(
      await this.requestRaw("POST", `${place}/terms?${query}`, file, { "Content-Type": type }),
    );
  }
  async templates(): Promise<wire.Template[]> {
    return this.all("/templates", "templates");
  }
  /** Makes its tables, and its layers on the model. */
  async useTemplate(project: Id, template: Id, use: wire.TemplateUse): Promise<TemplateMade> {
    const made = await this.json<wire.TemplateMade>(
      "POST",
      `${projectPath(project)}/templates/${encodeURIComponent(template)}`,
      use,
    );
    return { tables: made.tables, layers: made.layers.map(completeLayer) };
  }
  async hasRecord(table: Id, key: number): Promise<boolean> {
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
  async createTool(picture: Blob, name: string, part: string): Promise<wire.Tool> {
    const query = new URLSearchParams({ name, part });
    const response = await this.requestRaw("POST", `/tools?${query}`, picture, {
      "Content-Type": picture.type,
    });
    return this.parsed<wire.Tool>(response);
  }
  async renameTool(tool: Id, name: string): Promise<wire.Tool> {
    return this.json("PATCH", `/tools/${encodeURIComponent(tool)}`, { name });
  }
  async deleteTool(tool: Id): Promise<void> {
    await this.request("DELETE", `/tools/${encodeURIComponent(tool)}`);
  }
  /** Where records of the layer lie, and how much surface they have. */
  async extent(model: Id, layer: Id, highlight: wire.Highlight): Promise<wire.Extent> {
    return this.json("POST", `${layerPath(model, layer)}/extent`, highlight);
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
      `${tablePath(table)}/columns/${encodeURIComponent(column)}/classes?${query}`,
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
    return this.profileOf(model, { camera, path, layers: [] });
  }
  /** The same, or through places; also as the CSV file that the server makes of it. */
  async profileOf(model: Id, line: ProfileLine): Promise<wire.Profile> {
    return this.json("POST", `/models/${encodeURIComponent(model)}/profile`, line);
  }
  async profileCsv(model: Id, line: ProfileLine): Promise<Blob> {
    return (
      await this.request("POST", `/models/${encodeURIComponent(model)}/profile`, line, {
        Accept: "text/csv",
      })
    ).blob();
  }
  async statistics(model: Id, layer: Id): Promise<Statistics> {
    return this.json("GET", `${layerPath(model, layer)}/statistics`);
  }
  /** Where the areas of a layer's classes are had as a sheet. */
  quantitiesUrl(model: Id, layer: Id, query: WorkbookQuery): string {
    return `${kBase}${layerPath(model, layer)}/quantities?${new URLSearchParams({ ...query })}`;
  }
  /**
   * Where outlines of a layer's classes, and lines and points of its records, are had for maps;
   * `along`: the way that the map is looked at.
   */
  featuresUrl(model: Id, layer: Id, query: { f: string; along: string; lang: string }): string {
    return `${kBase}${layerPath(model, layer)}/features?${new URLSearchParams({ ...query })}`;
  }
  /** Areas where two layers meet: layers of whole numbers or keys. */
  async crossTable(model: Id, rows: Id, columns: Id): Promise<wire.CrossTable> {
    return this.json("POST", `/models/${encodeURIComponent(model)}/cross-table`, { rows, columns });
  }
  async crossTableWorkbook(model: Id, rows: Id, columns: Id, query: WorkbookQuery): Promise<Blob> {
    const path = `/models/${encodeURIComponent(model)}/cross-table?${new URLSearchParams({ ...query })}`;
    return (await this.request("POST", path, { rows, columns }, kAnyFile)).blob();
  }

  /** Answered once it is durable. */
  async edit(model: Id, layer: Id, edit: wire.Edit): Promise<wire.EditResult> {
    return this.json("POST", `${layerPath(model, layer)}/edits`, edit);
  }

  /** Where a layer's texels are had as a file. */
  texelsUrl(model: Id, layer: Id, format: string): string {
    return `${kBase}${layerPath(model, layer)}/texels.${format}`;
  }
  /** The layer then holds what the file does. Answered once it is durable. */
  async putTexels(model: Id, layer: Id, format: string, file: Blob): Promise<wire.EditResult> {
    const path = `${layerPath(model, layer)}/texels.${format}`;
    const response = await this.requestRaw("PUT", path, file, {
      ...kFile,
      "Idempotency-Key": newId(),
    });
    return (await response.json()) as wire.EditResult;
  }

  /** Paints files over the layer. Answered once it is durable. */
  paintMap(
    model: Id,
    layer: Id,
    kind: "readings" | "polygons" | "picture",
    query: Record<string, string>,
    files: readonly UploadFile[],
    progress: Progress,
  ): Upload<wire.EditResult> {
    const path = `${layerPath(model, layer)}/${kind}?${new URLSearchParams(query)}`;
    // the names of maps tell what they are
    return this.upload("POST", path, files, progress, kind !== "readings");
  }
  /**
   * One number a line for each vertex of a scan; `source` where the model has several. Answered
   * once it is durable.
   */
  putVertexValues(
    model: Id,
    layer: Id,
    source: string | null,
    file: UploadFile,
    progress: Progress,
  ): Upload<wire.EditResult> {
    const query = source === null ? "" : `?${new URLSearchParams({ source })}`;
    return this.upload("PUT", `${layerPath(model, layer)}/vertices.csv${query}`, [file], progress);
  }
  /** What a map's files hold. */
  mapContents(
    model: Id,
    query: Record<string, string>,
    files: readonly UploadFile[],
    progress: Progress,
  ): Upload<wire.MapContents> {
    const path = `/models/${encodeURIComponent(model)}/map-contents?${new URLSearchParams(query)}`;
    return this.upload("POST", path, files, progress, true);
  }
  /** Makes a look of an orthophoto. */
  addOrthophoto(
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
  async makeFigure(model: Id, figure: wire.FigureRequest): Promise<Job> {
    return this.parsed(
      await this.request("POST", figuresPath(model), figure, { Prefer: "respond-async" }),
    );
  }
  /** The file itself, for small ones. */
  async figure(model: Id, figure: wire.FigureRequest, signal: AbortSignal): Promise<Blob> {
    return this.blob("POST", figuresPath(model), figure, signal);
  }
  /** What a job of this person made. */
  async jobFile(id: Id): Promise<Blob> {
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
    asForm = files.length > 1,
  ): Upload<T> {
    const form = new FormData();
    if (asForm) for (const each of files) form.append("files", each.file, each.path);
    const request = this._makeRequest();
    const done = new Promise<T>((resolve, reject) => {
      request.open(method, kBase + path);
      if (!asForm) request.setRequestHeader("Content-Type", "application/octet-stream");
      request.setRequestHeader("Idempotency-Key", newId());
      request.upload.onprogress = (event) => {
        if (event.lengthComputable) progress(event.loaded / event.total);
      };
      request.onload = () => {
        if (request.status >= 400) {
          reject(new ApiError(problemOfText(request.status, request.responseText)));
          return;
        }
        try {
          resolve(JSON.parse(request.responseText) as T);
        } catch {
          reject(new ApiError(problemOfText(502, "")));
        }
      };
      request.onerror = () => reject(unreachable());
      request.onabort = () => reject(cancelled());
      request.send(asForm ? form : files[0]!.file);
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
      next = nextPage(response.headers.get("Link"));
    }
    return found;
  }

  /** A change that stands on its own, of whatever is there now. */
  private async changeAsIs<T>(path: string, change: unknown): Promise<T> {
    return (await this.versioned<T>("PATCH", path, change, "*")).value;
  }
  private async deleteAsIs(path: string): Promise<void> {
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
      throw new ApiError(problemOfText(502, ""));
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
    if (body === undefined) return this.requestRaw(method, path, null, headers, signal);
    return this.requestRaw(
      method,
      path,
      JSON.stringify(body),
      { "Content-Type": "application/json", ...headers },
      signal,
    );
  }

  private async requestRaw(
    method: string,
    path: string,
    body: BodyInit | null,
    headers: Record<string, string> = {},
    signal?: AbortSignal,
    keepalive = false,
  ): Promise<Response> {
    const all: Record<string, string> = { Accept: "application/json", ...headers };
    if (method === "POST" && !kWithSecrets.test(path)) all["Idempotency-Key"] ??= newId();
    let response: Response;
    try {
      response = await this._fetch(kBase + path, {
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
      throw new ApiError(problemOfText(response.status, await response.text().catch(() => "")));
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

const layerPath = (model: Id, layer: Id): string =>
  `/models/${encodeURIComponent(model)}/layers/${encodeURIComponent(layer)}`;

const personPath = (user: string): string => `/users/${encodeURIComponent(user)}`;
const projectGroupPath = (project: string, group: number): string =>
  `/projects/${encodeURIComponent(project)}/groups/${group}`;
const memberPath = (project: string, user: string): string =>
  `/projects/${encodeURIComponent(project)}/members/${encodeURIComponent(user)}`;

const projectPath = (project: Id): string => `/projects/${encodeURIComponent(project)}`;

const tablePath = (table: Id): string => `/tables/${encodeURIComponent(table)}`;

const columnPath = (table: Id, column: Id): string =>
  `${tablePath(table)}/columns/${encodeURIComponent(column)}`;

const recordsPath = (place: RecordPlace): string =>
  `${"table" in place ? tablePath(place.table) : layerPath(place.model, place.layer)}/records`;

const commentPath = (id: number): string => `/comments/${id}`;

const figuresPath = (model: Id): string =>
  `/models/${encodeURIComponent(model)}/figures?${new URLSearchParams({ lang: pageLocale() })}`;

const viewsPath = (model: Id): string => `/models/${encodeURIComponent(model)}/views`;
const viewPath = (model: Id, view: Id): string => `${viewsPath(model)}/${encodeURIComponent(view)}`;

const toursPath = (model: Id): string => `/models/${encodeURIComponent(model)}/tours`;
const tourPath = (model: Id, tour: Id): string => `${toursPath(model)}/${encodeURIComponent(tour)}`;
const kioskPath = (kiosk: number): string => `/kiosks/${kiosk}`;

const etagOf = (version: number): string => `"v${version}"`;

const lookPath = (model: Id, look: Id): string =>
  `/models/${encodeURIComponent(model)}/looks/${encodeURIComponent(look)}`;

const cancelled = (): ApiError => new ApiError({ status: 499, title: "Cancelled" });

function unreachable(): ApiError {
  const [title, detail] = ownProblems().unreachable;
  return new ApiError({ status: 0, title, detail });
}

/**
 * Where the next page of a list is, below `kBase`, by the `Link` of this one (RFC 8288); null: it
 * is the last.
 */
export function nextPage(link: string | null): string | null {
  const target = /<([^>]*)>\s*;\s*rel="?next"?/.exec(link ?? "")?.[1];
  return target?.startsWith(kBase) ? target.slice(kBase.length) : null;
}

/**
 * The problem in an answer's text; where the text is not one, what the status means in plain words.
 */
export function problemOfText(status: number, text: string): ProblemBody {
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
  const words = ownProblems();
  const [title, detail] = words.statuses[status] ?? [
    words.other_status(status),
    words.other_status_detail,
  ];
  return { status, title, detail };
}

/** A model's name from its file's: "statue_nefertiti_70k.ply" → "statue nefertiti 70k". */
export function nameOfFile(filename: string): string {
  const stem = filename
    .replace(/\.[a-z0-9]{1,5}$/i, "")
    .replace(/_+/g, " ")
    .trim();
  return stem || filename;
}

/** A random UUID; also on plain-HTTP addresses, where `crypto.randomUUID` is absent. */
export function newId(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  bytes[6] = (bytes[6]! & 0x0f) | 0x40;
  bytes[8] = (bytes[8]! & 0x3f) | 0x80;
  const hex = [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
  return `${hex.slice(0, 8)}-${hex.slice(8, 12)}-${hex.slice(12, 16)}-${hex.slice(16, 20)}-${hex.slice(20)}`;
}
