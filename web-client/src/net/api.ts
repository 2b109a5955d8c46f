// The HTTP interface, with the types of the contract. Every failure is an ApiError.

import { newId } from "../core/ids";
import { ApiError, cancelled, problemOfText, unreachable } from "./api-error";
import type { Answer, Call, Entry, Given, ListName, Options } from "./calls";
import { countedFetch } from "./counted-fetch";
import { uploadFiles, type Progress, type Upload, type UploadFile } from "./upload";

export interface Versioned<T> {
  value: T;
  etag: string;
}

export type Fetch = (input: string, init?: RequestInit) => Promise<Response>;

/** The options of any call. */
interface AnyOptions {
  path?: object;
  query?: object | undefined;
  header?: object | undefined;
  body?: unknown;
  type?: string;
  accept?: string;
  signal?: AbortSignal;
  keepalive?: boolean;
}

const kBase = "/api/v1";

export class Api {
  constructor(
    private readonly _fetch: Fetch = countedFetch,
    private readonly _makeRequest: () => XMLHttpRequest = () => new XMLHttpRequest(),
  ) {}

  async json<C extends Call>(call: C, ...[options]: Given<Options<C>>): Promise<Answer<C>> {
    return parsed(await this.request(call, options));
  }

  /** Returns the value with its ETag, which is "" if the response has none. */
  async versioned<C extends Call>(
    call: C,
    ...[options]: Given<Options<C>>
  ): Promise<Versioned<Answer<C>>> {
    const response = await this.request(call, options);
    return { value: await parsed(response), etag: response.headers.get("ETag") ?? "" };
  }

  /** Sends a call whose response has no content. */
  async send<C extends Call>(call: C, ...[options]: Given<Options<C>>): Promise<void> {
    await this.request(call, options);
  }

  /** Reads a resource and deletes the version that was read. */
  async deleteAsRead<C extends Call & `DELETE ${string}`>(
    call: C,
    options: Pick<Options<C>, "path" & keyof Options<C>>,
  ): Promise<void> {
    const read = await this.request(call.replace("DELETE", "GET") as Call, options);
    const header = { "If-Match": read.headers.get("ETag") ?? "" };
    await this.request(call, { ...options, header });
  }

  /**
   * Reads all entries of a list, page by page. Each page begins after the last entry of the
   * previous page, even if entries were written in the meantime.
   */
  async all<C extends Call, K extends ListName<Answer<C>>>(
    call: C,
    list: K,
    ...[options]: Given<Options<C>>
  ): Promise<Entry<Answer<C>, K>[]> {
    type Page = Record<K, Entry<Answer<C>, K>[]>;
    const found: Page[K] = [];
    const given: AnyOptions | undefined = options;
    const first = targetOf(call, { ...given, query: { limit: 1000 } });
    for (let next: string | null = first; next !== null;) {
      const response: Response = await this.request(call, {}, next);
      found.push(...(await parsed<Page>(response))[list]);
      next = nextPage(response.headers.get("Link"));
    }
    return found;
  }

  /**
   * Reads one page of a list. `next` is the address of the next page, which is null after the last
   * one. Pass it as `at` to read that page.
   */
  async page<C extends Call>(
    call: C,
    options: Options<C>,
    at: string | null = null,
  ): Promise<{ value: Answer<C>; next: string | null }> {
    const response = await this.request(call, {}, at ?? targetOf(call, options));
    const value = await parsed<Answer<C>>(response);
    return { value, next: nextPage(response.headers.get("Link")) };
  }

  /** Reads a file. The request can be canceled, also during the transfer. */
  async blob<C extends Call>(call: C, ...[options]: Given<Options<C>>): Promise<Blob> {
    const given: AnyOptions | undefined = options;
    // The server refuses a request that accepts only JSON if the response is a file of another
    // type.
    const response = await this.request(call, { accept: "*/*", ...given });
    try {
      return await response.blob();
    } catch {
      throw given?.signal?.aborted ? cancelled() : unreachable();
    }
  }

  /** Sends files as a form, or a single file as the body. */
  upload<C extends Call>(
    call: C,
    options: Omit<Options<C>, "body">,
    files: readonly UploadFile[],
    progress: Progress,
    asForm = files.length > 1,
  ): Upload<Answer<C>> {
    const request = this._makeRequest();
    request.open(methodOf(call), kBase + targetOf(call, options));
    return uploadFiles(request, files, progress, asForm);
  }

  /** Returns the address of a call, for links and downloads. */
  url<C extends Call>(call: C, ...[options]: Given<Options<C>>): string {
    const given: AnyOptions | undefined = options;
    return kBase + targetOf(call, given ?? {});
  }

  private async request(
    call: Call,
    options: AnyOptions = {},
    target = targetOf(call, options),
  ): Promise<Response> {
    const { header, body, type, accept = "application/json", signal, keepalive } = options;
    const isFile = body instanceof Blob;
    const headers: Record<string, string> = {
      Accept: accept,
      ...(body === undefined
        ? {}
        : { "Content-Type": isFile ? type || kAnyFile : "application/json" }),
      ...header,
    };
    const method = methodOf(call);
    if (method === "POST" && !kWithSecrets.test(call)) headers["Idempotency-Key"] ??= newId();
    let response: Response;
    try {
      response = await this._fetch(kBase + target, {
        method,
        headers,
        credentials: "same-origin",
        ...(body === undefined ? {} : { body: isFile ? body : JSON.stringify(body) }),
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

const kAnyFile = "application/octet-stream";

/**
 * Calls with secrets in the request or response. They have no `Idempotency-Key`, because the server
 * would store their responses.
 */
const kWithSecrets =
  /^POST \/(login|auth\/.+|invitations\/.+|me\/.+|users|users\/.+|models\/[^/]+\/tours\/[^/]+\/kiosks)$/;

const methodOf = (call: Call): string => call.slice(0, call.indexOf(" "));

/** Returns the path with its parameters filled in, and the query. */
function targetOf(call: Call, { path = {}, query = {} }: AnyOptions): string {
  const parts = path as Record<string, unknown>;
  const filled = call
    .slice(call.indexOf(" ") + 1)
    .replace(/\{(\w+)\}/g, (_, name: string) => encodeURIComponent(String(parts[name])));
  const asked = Object.entries(query).filter(([, value]) => value !== undefined);
  return asked.length > 0 ? `${filled}?${new URLSearchParams(asked as string[][])}` : filled;
}

/** Returns the header for a change that applies only to the version that was read. */
export const ifVersion = (version: number): { "If-Match": string } => ({
  "If-Match": `"v${version}"`,
});
/** The header for a change that applies to any version. */
export const kAsItIs = { "If-Match": "*" };

async function parsed<T>(response: Response): Promise<T> {
  try {
    return (await response.json()) as T;
  } catch {
    throw new ApiError(problemOfText(502, ""));
  }
}

/**
 * Returns the address of the next page of a list, below `kBase`, from the `Link` header of the
 * current page (RFC 8288). Returns null after the last page.
 */
export function nextPage(link: string | null): string | null {
  const target = /<([^>]*)>\s*;\s*rel="?next"?/.exec(link ?? "")?.[1];
  return target?.startsWith(kBase) ? target.slice(kBase.length) : null;
}
