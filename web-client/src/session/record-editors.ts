// Who writes into which record just now, and the records that this page has open to be written
// into. It is advice, so that people do not surprise each other: what protects the data is the
// record's version, and without a connection everybody writes as they like.

import type { RecordEditor, RecordEditors as EditorsMessage } from "../core/protocol.gen";

export interface RecordEditorsHost {
  /** Nothing is sent while there is no connection. */
  say(what: { table: number; key: number; editing: boolean; take_over?: boolean }): void;
  /** What somebody is called. */
  name_of(user: string): string;
  changed(): void;
}

/** Somebody else, by what they are called, or this person in another window. */
export interface OtherEditor {
  user: string;
  is_me: boolean;
}

const id_of = (table: number, key: number): string => `${table} ${key}`;

/** A record that is open here, until `release`. */
export class RecordClaim {
  /** It was written into from here. */
  had = false;

  constructor(
    private readonly editors_: RecordEditors,
    readonly table: number,
    readonly key: number,
  ) {}

  /** Null: it is free to be written into here. */
  get other(): OtherEditor | null {
    return this.editors_.other(this.table, this.key);
  }
  /** Somebody took it over. */
  get lost(): boolean {
    return this.had && this.other !== null;
  }
  take_over(): void {
    this.editors_.take_over(this);
  }
  release(): void {
    this.editors_.release(this);
  }
}

export class RecordEditors {
  private me_ = { session: "", user: "" };
  private readonly there_ = new Map<string, { session: string; user: string }>();
  private readonly claims_ = new Set<RecordClaim>();

  constructor(private readonly host_: RecordEditorsHost) {}

  other(table: number, key: number): OtherEditor | null {
    const there = this.there_.get(id_of(table, key));
    return there && there.session !== this.me_.session
      ? { user: this.host_.name_of(there.user), is_me: there.user === this.me_.user }
      : null;
  }

  claim(table: number, key: number): RecordClaim {
    const claim = new RecordClaim(this, table, key);
    if (!this.claimed(table, key)) this.host_.say({ table, key, editing: true });
    else claim.had = this.there_.get(id_of(table, key))?.session === this.me_.session;
    this.claims_.add(claim);
    return claim;
  }

  take_over({ table, key }: RecordClaim): void {
    this.host_.say({ table, key, editing: true, take_over: true });
    this.there_.delete(id_of(table, key)); // the server will tell that it is ours
    this.host_.changed();
  }

  release(claim: RecordClaim): void {
    const { table, key } = claim;
    if (this.claims_.delete(claim) && !this.claimed(table, key))
      this.host_.say({ table, key, editing: false });
  }

  /** A new connection, which knows nothing of what is open here. */
  joined(session: string, user: string): void {
    this.me_ = { session, user };
    this.there_.clear();
    const said = new Set<string>();
    for (const { table, key } of this.claims_) {
      if (said.has(id_of(table, key))) continue;
      said.add(id_of(table, key));
      this.host_.say({ table, key, editing: true });
    }
    this.host_.changed();
  }

  /** The connection is gone: nobody is known to be anywhere. */
  left(): void {
    this.there_.clear();
    this.host_.changed();
  }

  on_message({ records }: EditorsMessage): void {
    for (const record of records) this.take(record);
    this.host_.changed();
  }

  private take({ table, key, session, user }: RecordEditor): void {
    if (session === undefined) {
      this.there_.delete(id_of(table, key));
      // it is ours now, if nobody was quicker
      if (this.claimed(table, key)) this.host_.say({ table, key, editing: true });
      return;
    }
    this.there_.set(id_of(table, key), { session, user: user ?? "" });
    if (session !== this.me_.session) return;
    for (const claim of this.claims_)
      if (claim.table === table && claim.key === key) claim.had = true;
  }

  private claimed(table: number, key: number): boolean {
    return [...this.claims_].some((claim) => claim.table === table && claim.key === key);
  }
}
