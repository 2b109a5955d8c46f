// Uploads files with progress, which `fetch` does not report.

import { newId } from "../core/ids";
import { ApiError, cancelled, problemOfText, unreachable } from "./api-error";

/** A file with its path. Other files of the same scan refer to it by this path. */
export interface UploadFile {
  file: File;
  path: string;
}

export const asUploads = (files: readonly File[]): UploadFile[] =>
  files.map((file) => ({ file, path: file.name }));

export interface Upload<T> {
  /** Resolves with the response. */
  done: Promise<T>;
  cancel(): void;
}

/** Receives the fraction of sent bytes, from 0 to 1. */
export type Progress = (share: number) => void;

/** Sends an opened request, with the files as a form or with a single file as the body. */
export function uploadFiles<T>(
  request: XMLHttpRequest,
  files: readonly UploadFile[],
  progress: Progress,
  asForm: boolean,
): Upload<T> {
  const form = new FormData();
  if (asForm) for (const each of files) form.append("files", each.file, each.path);
  const done = new Promise<T>((resolve, reject) => {
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
