// The types of the parameters and responses of each call of the HTTP interface, from the contract.

import type { paths } from "./contract.gen";

type Method = "get" | "post" | "put" | "patch" | "delete";

/** A call, given by its method and path, such as "PATCH /models/{model}". */
export type Call = {
  [P in keyof paths]: {
    [M in Method]: paths[P][M] extends object ? `${Uppercase<M>} ${P}` : never;
  }[Method];
}[keyof paths];

type Operation<C extends Call> = C extends `${infer M} ${infer P}`
  ? paths[P & keyof paths][Lowercase<M> & Method]
  : never;

/** An id or a slug. */
export type Id = number | string;

type Parameters<C extends Call> =
  Operation<C> extends { parameters: infer P extends { query?: object; header?: object } }
    ? Pick<P, "query"> & Path<P> & Header<C, Exclude<P["header"], undefined>>
    : never;
/** Changes to versioned resources require `If-Match`. The compiler rejects a call without it. */
type Header<C, H> = [H] extends [never]
  ? unknown
  : [C, "If-Match"] extends [`${"PATCH" | "DELETE"} ${string}`, keyof H]
    ? { header: Partial<H> & { "If-Match": string } }
    : { header?: H };
type Path<P> = P extends { path: infer I } ? { path: { [K in keyof I]: Id } } : unknown;

type Body<O> = O extends { requestBody: { content: infer T } }
  ? { body: T extends { "application/json": infer J } ? Sent<J> | FileIn<T> : FileIn<T> }
  : { body?: undefined };
/** The type of a sent value, which may be read-only. */
export type Sent<T> = T extends object ? { readonly [K in keyof T]: Sent<T[K]> } : T;
type FileIn<T> = Exclude<keyof T, "application/json"> extends never ? never : Blob;

export type Options<C extends Call> = Parameters<C> &
  Body<Operation<C>> & {
    /** The media type of a file to send. */
    type?: string;
    /** The accepted media type, instead of JSON. */
    accept?: string;
    signal?: AbortSignal;
    /** Whether the request continues after the page is closed. */
    keepalive?: boolean;
  };
export type Query<C extends Call> = NonNullable<Options<C>["query"]>;

/** Makes the options optional if the call requires none. */
export type Given<O> = object extends O ? [options?: O] : [options: O];

type Json<R> = R extends { content: { "application/json": infer T } } ? T : never;
/** The JSON response of a call. */
export type Answer<C extends Call> =
  Operation<C> extends { responses: infer R } ? Json<R[keyof R]> : never;

/** The member of a response that contains its list. */
export type ListName<A> = {
  [K in keyof A]: A[K] extends readonly unknown[] ? K : never;
}[keyof A] &
  string;
export type Entry<A, K extends keyof A> = A[K] extends readonly (infer E)[] ? E : never;
