// What each call of the HTTP interface takes and gives, by the contract. Types alone.

import type { paths } from "./contract.gen";

type Method = "get" | "post" | "put" | "patch" | "delete";

/** A call by its method and its path, as in "PATCH /models/{model}". */
export type Call = {
  [P in keyof paths]: {
    [M in Method]: paths[P][M] extends object ? `${Uppercase<M>} ${P}` : never;
  }[Method];
}[keyof paths];

type Operation<C extends Call> = C extends `${infer M} ${infer P}`
  ? paths[P & keyof paths][Lowercase<M> & Method]
  : never;

/** An id, or a slug in its place. */
export type Id = number | string;

type Parameters<C extends Call> =
  Operation<C> extends { parameters: infer P extends { query?: object; header?: object } }
    ? Pick<P, "query"> & Path<P> & Header<C, Exclude<P["header"], undefined>>
    : never;
/** What has a version is changed as it was read: the compiler finds a change that names none. */
type Header<C, H> = [H] extends [never]
  ? unknown
  : [C, "If-Match"] extends [`${"PATCH" | "DELETE"} ${string}`, keyof H]
    ? { header: Partial<H> & { "If-Match": string } }
    : { header?: H };
type Path<P> = P extends { path: infer I } ? { path: { [K in keyof I]: Id } } : unknown;

type Body<O> = O extends { requestBody: { content: infer T } }
  ? { body: T extends { "application/json": infer J } ? Sent<J> | FileIn<T> : FileIn<T> }
  : { body?: undefined };
/** What is only read is taken as well. */
export type Sent<T> = T extends object ? { readonly [K in keyof T]: Sent<T[K]> } : T;
type FileIn<T> = Exclude<keyof T, "application/json"> extends never ? never : Blob;

export type Options<C extends Call> = Parameters<C> &
  Body<Operation<C>> & {
    /** Of a file that is sent. */
    type?: string;
    /** In place of JSON. */
    accept?: string;
    signal?: AbortSignal;
    /** Sent also when its page is left. */
    keepalive?: boolean;
  };
export type Query<C extends Call> = NonNullable<Options<C>["query"]>;

/** No options at all where the call needs none. */
export type Given<O> = object extends O ? [options?: O] : [options: O];

type Json<R> = R extends { content: { "application/json": infer T } } ? T : never;
/** Of a call that is answered with JSON. */
export type Answer<C extends Call> =
  Operation<C> extends { responses: infer R } ? Json<R[keyof R]> : never;

/** Of an answer that is a list: what it calls its entries. */
export type ListName<A> = {
  [K in keyof A]: A[K] extends readonly unknown[] ? K : never;
}[keyof A] &
  string;
export type Entry<A, K extends keyof A> = A[K] extends readonly (infer E)[] ? E : never;
