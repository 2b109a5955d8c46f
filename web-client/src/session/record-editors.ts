// The current editors of records, and the records that this page has open for editing. These claims
// do not lock a record, but only show users that another user is editing it. The version of the
// record protects the data. Without a connection, all users can edit.

import type { RecordEditor, RecordEditors as EditorsMessage } from "../core/protocol.gen";

export interface RecordEditorsHost {
  /** Sends a claim to the server. Has no effect without a connection. */
  say(what: { table: number; key: number; editing: boolean; take_over?: boolean }): void;
  /** Returns the displayed name of a user. */
  nameOf(user: string): string;
  changed(): void;
}

/** Another user with this name, or this user in another window. */
export interface OtherEditor {
  user: string;
  isMe: boolean;
}

const idOf = (table: number, key: number): string => `${table} ${key}`;

/** A record that is open for editing in this page, until `release`. */
export class RecordClaim {
  /** Whether this page was the editor of the record. */
  had = false;

  constructor(
    private readonly _editors: RecordEditors,
    readonly table: number,
    readonly key: number,
  ) {}

  /** The other editor of the record. Null if this page may edit it. */
  get other(): OtherEditor | null {
    return this._editors.other(this.table, this.key);
  }
  /** Whether another editor has taken the record over. */
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
    this._there.delete(idOf(table, key)); // the server confirms this with an event
    this._host.changed();
  }

  release(claim: RecordClaim): void {
    const { table, key } = claim;
    if (this._claims.delete(claim) && !this.claimed(table, key))
      this._host.say({ table, key, editing: false });
  }

  /** Sends the claims of this page over a new connection. */
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

  /** Removes all editors, because they are unknown after the connection was lost. */
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
      // This page becomes the editor, unless another page is faster.
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
