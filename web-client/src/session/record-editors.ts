// The current editors of records, and the records that this page has open for editing. These claims
// are advice, so that people do not surprise each other: the record's version protects the data,
// and without a connection everyone can edit.

import type { RecordEditor, RecordEditors as EditorsMessage } from "../core/protocol.gen";

export interface RecordEditorsHost {
  /** Sends nothing without a connection. */
  say(what: { table: number; key: number; editing: boolean; take_over?: boolean }): void;
  /** The name of a user. */
  nameOf(user: string): string;
  changed(): void;
}

/** Another person with their name, or this person in another window. */
export interface OtherEditor {
  user: string;
  isMe: boolean;
}

const idOf = (table: number, key: number): string => `${table} ${key}`;

/** A record that is open in this page, until `release`. */
export class RecordClaim {
  /** This page was its editor. */
  had = false;

  constructor(
    private readonly _editors: RecordEditors,
    readonly table: number,
    readonly key: number,
  ) {}

  /** Null: this page may edit it. */
  get other(): OtherEditor | null {
    return this._editors.other(this.table, this.key);
  }
  /** Another person has taken it over. */
  get lost(): boolean {
    return this.had && this.other !== null;
  }
  takeOver(): void {
    this._editors.takeOver(this);
  }
  release(): void {
    this._editors.release(this);
  }
}

export class RecordEditors {
  private _me = { session: "", user: "" };
  private readonly _there = new Map<string, { session: string; user: string }>();
  private readonly _claims = new Set<RecordClaim>();

  constructor(private readonly _host: RecordEditorsHost) {}

  other(table: number, key: number): OtherEditor | null {
    const there = this._there.get(idOf(table, key));
    return there && there.session !== this._me.session
      ? { user: this._host.nameOf(there.user), isMe: there.user === this._me.user }
      : null;
  }

  claim(table: number, key: number): RecordClaim {
    const claim = new RecordClaim(this, table, key);
    if (!this.claimed(table, key)) this._host.say({ table, key, editing: true });
    else claim.had = this._there.get(idOf(table, key))?.session === this._me.session;
    this._claims.add(claim);
    return claim;
  }

  takeOver({ table, key }: RecordClaim): void {
    this._host.say({ table, key, editing: true, take_over: true });
    this._there.delete(idOf(table, key)); // the server's event will confirm it
    this._host.changed();
  }

  release(claim: RecordClaim): void {
    const { table, key } = claim;
    if (this._claims.delete(claim) && !this.claimed(table, key))
      this._host.say({ table, key, editing: false });
  }

  /** A new connection, which has no state of this page. */
  joined(session: string, user: string): void {
    this._me = { session, user };
    this._there.clear();
    const said = new Set<string>();
    for (const { table, key } of this._claims) {
      if (said.has(idOf(table, key))) continue;
      said.add(idOf(table, key));
      this._host.say({ table, key, editing: true });
    }
    this._host.changed();
  }

  /** The connection was lost: all editors are unknown. */
  left(): void {
    this._there.clear();
    this._host.changed();
  }

  onMessage({ records }: EditorsMessage): void {
    for (const record of records) this.take(record);
    this._host.changed();
  }

  private take({ table, key, session, user }: RecordEditor): void {
    if (session === undefined) {
      this._there.delete(idOf(table, key));
      // this page gets it unless another person is faster
      if (this.claimed(table, key)) this._host.say({ table, key, editing: true });
      return;
    }
    this._there.set(idOf(table, key), { session, user: user ?? "" });
    if (session !== this._me.session) return;
    for (const claim of this._claims)
      if (claim.table === table && claim.key === key) claim.had = true;
  }

  private claimed(table: number, key: number): boolean {
    return [...this._claims].some((claim) => claim.table === table && claim.key === key);
  }
}
