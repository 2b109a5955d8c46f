#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/attachment.h"
#include "core/expression.h"
#include "core/history.h"
#include "core/key_colors.h"
#include "core/key_numbers.h"
#include "core/layer.h"
#include "core/look.h"
#include "core/mark.h"
#include "core/model.h"
#include "core/shape_texture.h"
#include "core/term.h"
#include "core/tile_mirror.h"
#include "core/tool.h"
#include "store/activity.h"
#include "store/first_answer.h"
#include "store/journal.h"
#include "store/people.h"
#include "store/pg_limits.h"
#include "store/table_changes.h"

namespace strata::store {

class Bin;
class Comments;
class Groups;
class Jobs;
class Kiosks;
class NamedParts;

struct StoreOptions {
  std::string dsn;      // libpq connection string
  int connections = 8;  // pooled, for everything but the journal writer
  PgLimits limits = kRequestLimits;
  std::chrono::milliseconds slot_for{10'000};  // longest wait for one of the pool
};

struct StoreInfo {
  std::string server_version;
  std::int64_t schema_version = 0;
  std::uint64_t database_bytes = 0;
};

// Everything durable. All calls block the calling thread, are thread-safe and take a connection
// from the pool; when the database is away they return an Error unavailable ("Database
// unavailable") after trying to reconnect. Constraint failures are an Error conflict, unknown ids
// not_found, a stale `version` `stale`. Changes keep the caller's answer with them (FirstAnswer).
class Store {
 public:
  // Connects and applies the missing migrations of `migrations_dir`; a newer schema than known is
  // refused.
  static Result<std::unique_ptr<Store>> open(StoreOptions options,
                                             const std::filesystem::path& migrations_dir);
  ~Store();

  Result<StoreInfo> info();
  // One round trip, of 2 seconds at most (4 where it must connect first); while another thread
  // asks, the last answer.
  bool ready();

  // --- projects; `default` exists from the start. `ref` is an id in digits or a slug.
  Result<std::vector<Project>> projects();
  Result<Project> project(const std::string& ref);
  Result<Project> create_project(Project project, const FirstAnswer<Project>& answer = {});
  // Where version equals; returns it with version + 1.
  Result<Project> update_project(Project project, const FirstAnswer<Project>& answer = {});
  // refused (conflict) while it has models, and for `default`
  Result<void> delete_project(std::int64_t id, const FirstAnswer<>& answer = {});
  // How many of the things, which are sorted by their names without regard to case and then by ids,
  // do not come after that place.
  struct NamedId {
    std::string name;
    std::int64_t id = 0;
  };
  Result<std::size_t> names_until(const NamedId& place, std::span<const NamedId> sorted);
  // Of all that is stored of it but edits, comments and people: another text whenever one of its
  // models, layers, looks, views or tables was changed, made or deleted, or a record of its tables.
  // For comparison alone.
  Result<std::string> project_state(std::int64_t id);
  // What was done in it, but for what is about layers that the role does not see; a page costs the
  // same however long its history is. An unknown project or model has none.
  Result<ActivityPage> activity(std::int64_t project_id, Role seen_by, const ActivityQuery& query);

  // --- models
  struct NewModel {
    Model model;                         // id 0; slug wished, made unique
    std::vector<std::uint8_t> geometry;  // mesh::encode_geometry
    std::vector<std::vector<std::uint8_t>>
        detail_levels;  // of mesh::make_detail_levels, encoded likewise, finest first
    struct Source {
      std::string name;
      std::filesystem::path file;
    };
    std::vector<Source> sources;  // streamed in bit for bit, hashed on the way
    struct NewLook {
      std::string name, media_type;     // "image/jpeg" or "image/png"
      std::vector<std::uint8_t> bytes;  // of the encoded picture
      int width = 0, height = 0;
    };
    std::vector<NewLook> looks;  // bottom to top; the first is shown, the others wait to be chosen
  };
  Result<Model> create_model(const NewModel& model, const std::function<bool()>& cancelled,
                             const FirstAnswer<Model>& answer = {});  // one transaction
  Result<std::vector<Model>> models(std::optional<std::int64_t> project_id = {});
  Result<Model> model(const std::string& ref);
  Result<Model> update_model(Model model, const FirstAnswer<Model>& answer = {});
  // for ever; people's go by the Bin
  Result<void> delete_model(std::int64_t id, const FirstAnswer<>& answer = {});
  Result<std::vector<std::uint8_t>> geometry(std::int64_t model_id);
  // finest first
  Result<std::vector<std::vector<std::uint8_t>>> detail_levels(std::int64_t model_id);
  // Streams a source file in chunks ≤ 1 MiB; `sink` returns false to stop.
  Result<SourceFile> read_source(std::int64_t model_id, const std::string& name,
                                 const std::function<bool(std::span<const std::uint8_t>)>& sink);

  // --- looks: pictures of a model's surface, kept as they came
  static constexpr int kMostLooks = 32;                    // of a model
  Result<std::vector<Look>> looks(std::int64_t model_id);  // by order
  Result<Look> look(std::int64_t model_id, const std::string& ref);
  Result<Look> create_look(const Look& look, std::span<const std::uint8_t> picture,
                           const FirstAnswer<Look>& answer = {});
  // all but its picture
  Result<Look> update_look(const Look& look, const FirstAnswer<Look>& answer = {});
  Result<void> delete_look(std::int64_t id, const FirstAnswer<>& answer = {});
  Result<std::vector<std::uint8_t>> look_picture(std::int64_t id);

  Comments& comments();  // threads on models (store/comments.h); lives as long as this
  NamedParts& views();   // of models (store/named_parts.h); the same
  NamedParts& tours();   // the same
  Jobs& jobs();          // what is known of long work after a restart (store/jobs.h); the same
  Kiosks& kiosks();      // screens that show tours (store/kiosks.h); the same
  Groups& groups();      // of people (store/groups.h); the same
  Bin& bin();            // what was deleted and can be restored (store/bin.h); the same

  // --- tools: shapes for the brush, of the whole site
  static constexpr int kMostTools = 200;  // that are not deleted
  Result<std::vector<Tool>> tools();      // that are not deleted, by name
  // By slug, those that are not deleted; by id, deleted ones, too.
  Result<Tool> tool(const std::string& ref);
  Result<Tool> create_tool(const Tool& tool, const ShapeBits& shape,
                           const FirstAnswer<Tool>& answer = {});
  Result<Tool> update_tool(const Tool& tool, const FirstAnswer<Tool>& answer = {});  // its name
  Result<void> delete_tool(std::int64_t id, const FirstAnswer<>& answer = {});
  Result<ShapeBits> tool_shape(std::int64_t id);  // deleted or not

  // --- layers
  // Those that the role sees, by order; one that it does not see is not found.
  Result<std::vector<Layer>> layers(std::int64_t model_id, Role seen_by);
  Result<Layer> layer(std::int64_t model_id, const std::string& ref, Role seen_by);
  // A database layer that names no table gets one of its own name with `columns`.
  Result<Layer> create_layer(Layer layer, const FirstAnswer<Layer>& answer = {},
                             std::vector<Column> columns = {});
  Result<Layer> update_layer(Layer layer, const FirstAnswer<Layer>& answer = {});
  // for ever; people's go by the Bin
  Result<void> delete_layer(std::int64_t id, const FirstAnswer<>& answer = {});
  // Room for larger keys or values: its content, with all of its history, in a type that it
  // widens_to. Where version equals.
  Result<Layer> widen_layer(const Layer& layer, ValueType type,
                            const FirstAnswer<Layer>& answer = {});
  // --- computed layers: their formula is created and changed with them
  // Where the tables stand that the layer's formula reads, by id.
  Result<std::map<std::int64_t, std::int64_t>> table_sequences_of(std::int64_t layer_id);
  // The layer shows what `expression` is of everything up to these sequences of its model and of
  // tables.
  Result<Layer> layer_computed(std::int64_t layer_id, const std::string& expression,
                               std::int64_t sequence,
                               const std::map<std::int64_t, std::int64_t>& tables);
  // Automatic ones that something which they read has left behind; those computed longest ago come
  // first.
  Result<std::vector<Layer>> layers_to_recompute();

  // --- tables of a project, by id or slug. Changes of columns and records are entries of the
  // table's journal, of one person each. With the columns that the role sees: to it the others are
  // not there, neither by name nor in the past. A TableChange has all.
  Result<std::vector<Table>> tables(std::int64_t project_id, Role seen_by);  // by name
  Result<Table> table(const std::string& ref, Role seen_by);
  // with its columns
  Result<Table> create_table(const Table& table, const FirstAnswer<Table>& answer = {});
  // name, labels, description
  Result<Table> update_table(const Table& table, const FirstAnswer<Table>& answer = {});
  // refused (conflict) while something names it
  Result<void> delete_table(std::int64_t id, const FirstAnswer<>& answer = {});
  Result<std::vector<Layer>> layers_of_table(std::int64_t table_id, Role seen_by);
  // Several tables and the terms of those that are lists, all or none: where one of the changes has
  // problems, nothing was made. conflict: the project has a table of that name. Terms are the first
  // entry of their table's journal.
  struct NewTable {
    Table table;
    // of columns that name one of the tables before it: column → table, by their places
    std::map<std::size_t, std::size_t> targets{};
    std::optional<TermList> terms{};
  };
  Result<std::vector<TableChange>> create_tables(
      const std::vector<NewTable>& tables, bool dry_run, const std::string& user,
      const std::string& op, const FirstAnswer<std::vector<TableChange>>& answer = {});
  // Terms come into a list (conflict: the table is none) as one entry of its journal: those whose
  // URI or code is there change that record, the others are new, and what the text does not have
  // stays. All or none; problems name the term by its place.
  Result<TableChange> import_terms(std::int64_t table_id, const TermList& list, bool dry_run,
                                   const std::string& user,
                                   const FirstAnswer<TableChange>& answer = {});
  // Where the kind or target changes, the column makes way for a new one that takes over what it
  // can hold: `record` of the change says how much that was (`converted`, `lost`, `lost_keys`).
  Result<TableChange> create_column(std::int64_t table_id, const Column& column,
                                    const std::string& user,
                                    const FirstAnswer<TableChange>& answer = {});
  Result<TableChange> update_column(std::int64_t table_id, const Column& column,
                                    std::optional<std::int64_t> version, const std::string& user,
                                    const FirstAnswer<TableChange>& answer = {});
  // Who sees the column, now and in the past: no entry of the journal, so that nothing is seen
  // again by undo. Where version equals. Refused (invalid): a list of terms lives by the column, or
  // who writes records would not see it and must fill it.
  Result<Table> show_column(std::int64_t table_id, std::int64_t column_id, Visibility visibility,
                            std::int64_t version, const FirstAnswer<Table>& answer = {});
  Result<TableChange> drop_column(std::int64_t table_id, std::int64_t column_id,
                                  std::optional<std::int64_t> version, const std::string& user,
                                  const FirstAnswer<TableChange>& answer = {});

  // --- records
  struct RecordQuery {
    std::vector<std::pair<std::string, bool>> order;  // column (or `key`), descending
    std::optional<std::vector<std::int64_t>> keys;    // only these, by key, whatever the page
    std::optional<std::int64_t> at;                   // as after that sequence of the table
    std::int64_t limit = 100, offset = 0;
    std::optional<Expression> filter{};  // only those where this condition over columns holds
    // in whose alphabet texts are sorted ("de-at"); empty: in none in particular
    std::string language{};
    // Only records that follow this place in the order: what RecordPage::last was. Refused
    // (invalid, `after`): one of another order.
    std::optional<nlohmann::json> after{};
  };
  struct RecordPage {
    Table table;  // with the columns of then
    std::vector<Record> records;
    std::int64_t total = 0;
    // where the page ends, while records follow it: an array of texts, nulls and whole numbers
    std::optional<nlohmann::json> last{};
  };
  Result<RecordPage> records(std::int64_t table_id, Role seen_by, const RecordQuery& query);
  // What a number or a condition over columns is for each record, where it is known; after sequence
  // `at` of the table, or now. Refused (invalid at `field`): what the columns do not fit.
  Result<std::vector<KeyNumber>> record_numbers(std::int64_t table_id, Role seen_by,
                                                const Expression& expression,
                                                std::optional<std::int64_t> at,
                                                const std::string& field);
  // What a column holds for each record that has a value there, now: as text, canonical (of a term,
  // its key). Refused (invalid at `field`): a column that is not there or holds lists.
  Result<std::vector<KeyText>> record_texts(std::int64_t table_id, Role seen_by,
                                            const std::string& column, const std::string& field);
  // The lines and points that records of a table have on a model, by key; after sequence `at` of
  // the table, or now.
  Result<std::vector<KeyMark>> marks(std::int64_t table_id, Role seen_by, std::int64_t model_id,
                                     std::optional<std::int64_t> at = {});
  // All or none: where the change has problems, nothing was written.
  Result<TableChange> write_records(std::int64_t table_id, const WriteRecords& asked,
                                    const std::string& user,
                                    const FirstAnswer<TableChange>& answer = {});
  Result<TableChange> delete_record(std::int64_t table_id, std::int64_t key,
                                    std::optional<std::int64_t> version, const std::string& user,
                                    bool dry_run = false,
                                    const FirstAnswer<TableChange>& answer = {});
  Result<std::vector<std::int64_t>> missing_records(std::int64_t table_id,
                                                    std::span<const std::int64_t> keys);
  // Of the last change until a time, as `sequence_at`.
  Result<std::int64_t> table_sequence_at(std::int64_t table_id, const std::string& utc);
  // The same until an edit of a model was made.
  Result<std::int64_t> table_sequence_when(std::int64_t table_id, std::int64_t model_id,
                                           std::int64_t sequence);
  struct TableHistory {
    std::vector<TableEditRow> rows;
    std::int64_t total = 0;
  };
  // What was done to cells that the role does not see is left out, and what the entries say of
  // themselves with it. The newest first; `before`: only those with lower sequences.
  Result<TableHistory> table_history(std::int64_t table_id, Role seen_by,
                                     std::optional<std::int64_t> key, int limit, int offset,
                                     std::optional<std::int64_t> before = {});
  // The person's newest entry in force, or the one that was undone last; `conflict` where there is
  // none. Done where the table is as it was when it was planned (stale).
  Result<UndoPlan> plan_table_undo(std::int64_t table_id, const std::string& user, bool redo);
  Result<TableChange> undo_table(std::int64_t table_id, const std::string& user, bool redo,
                                 std::int64_t planned_at,
                                 const FirstAnswer<TableChange>& answer = {});

  // --- attachments: files that cells of picture and document columns list, streamed both ways
  struct NewAttachment {
    std::string name;
    std::filesystem::path file;
    std::string media_type;
    std::optional<int> width, height;
    Visibility visibility = Visibility::everyone;
  };
  struct Attached {
    TableChange change;
    std::vector<Attachment> attachments;  // in the order of the files
  };
  // Appends them to a record's cell, as one entry of the journal, or nothing at all. Without a
  // column: the first one of pictures where all of them are that, otherwise the first one of
  // documents.
  Result<Attached> attach(std::int64_t table_id, std::int64_t key,
                          std::optional<std::int64_t> column_id,
                          const std::vector<NewAttachment>& files,
                          std::optional<std::int64_t> version, const Author& who,
                          const FirstAnswer<Attached>& answer = {});
  // Takes it out of all cells that list it; `not_found` where none does. It stays for undo and for
  // reading the past.
  Result<TableChange> detach(std::int64_t attachment_id, const std::string& user,
                             const FirstAnswer<TableChange>& answer = {});
  // One that they do not see is not found.
  Result<Attachment> attachment(std::int64_t id, const Author& seen_by);
  // Those of the ids that the table has and they see, by id.
  Result<std::vector<Attachment>> attachments(std::int64_t table_id, const Author& seen_by,
                                              std::span<const std::int64_t> ids);
  Result<Attachment> show_attachment(std::int64_t id, Visibility visibility,
                                     const FirstAnswer<Attachment>& answer = {});
  // The bytes from `begin` to before `end`, in pieces ≤ 1 MiB; `sink` returns false to stop.
  Result<void> read_attachment(const Attachment& attachment, std::uint64_t begin, std::uint64_t end,
                               const std::function<bool(std::span<const std::uint8_t>)>& sink);
  // Small pictures, kept once made; all attachments of one content share them.
  Result<std::optional<std::vector<std::uint8_t>>> thumbnail(const Attachment& attachment,
                                                             int side);
  Result<void> keep_thumbnail(const Attachment& attachment, int side,
                              std::span<const std::uint8_t> picture);
  // Deletes contents that no model, look or attachment has any more, and tells how many they were.
  // At start and after a table is deleted.
  Result<std::int64_t> drop_orphans();

  // --- journal (reads; writes go through JournalWriter)
  // All tiles of a layer after `at_sequence` (nothing: the newest).
  Result<TileMirror::Snapshot> load_tiles(const Layer& layer,
                                          std::optional<std::int64_t> at_sequence = {});
  // Revisions of a tile that are older than `before`, newest first, `limit` at most, with what
  // their edits are now.
  Result<std::vector<PastRevision>> tile_history(const Layer& layer, TileAddress tile,
                                                 std::int64_t before, int limit);
  // Tiles that the given edits wrote, with the union of their written masks.
  struct WrittenTiles {
    TileAddress tile;
    TileMask written;
  };
  Result<std::vector<WrittenTiles>> written_by(const Layer& layer,
                                               std::span<const std::int64_t> sequences);
  struct HistoryPage {
    std::vector<JournalRow> rows;
    std::int64_t total = 0;
  };
  // The newest first; `before`: only those with lower sequences.
  Result<HistoryPage> history(std::int64_t layer_id, int limit, int offset,
                              std::optional<std::int64_t> before = {});
  // The model's last sequence, and those of the messages that were in the journal after it was
  // read.
  struct JournalState {
    std::int64_t last_sequence = 0;
    std::vector<JournalRow> known;
  };
  Result<JournalState> journal_state(std::int64_t model_id, std::span<const Uuid> ids);
  // The sequences (ascending) of the newest stroke of `user` on the layer that is in force / that
  // is undone and not followed by a newer in-force stroke of the same user; empty when there is
  // none. `pending_only`: of those that wait for review.
  Result<std::vector<std::int64_t>> undoable(std::int64_t layer_id, const std::string& user,
                                             bool pending_only = false);
  Result<std::vector<std::int64_t>> redoable(std::int64_t layer_id, const std::string& user,
                                             bool pending_only = false);
  // review.cpp: strokes and other edits in force on a layer that wait for review, the oldest first.
  // `after`: only those that begin with a higher sequence.
  Result<ReviewQueue> review_queue(std::int64_t layer_id, const std::optional<std::string>& user,
                                   int limit, int offset, std::int64_t after = 0);
  // The edits that a decision is about: those that wait, in force, and with `reopen` those that
  // were accepted or rejected. Batches of a stroke belong together: one of them stands for all.
  Result<std::vector<UnderReview>> under_review(std::int64_t layer_id, Decision decision,
                                                const Reviewees& which);
  Result<std::int64_t> last_sequence(std::int64_t model_id);
  // Of the last edit until a time (core/timestamp.h's text); 0 before the first.
  Result<std::int64_t> sequence_at(std::int64_t model_id, const std::string& utc);
  Result<std::uint64_t> revision_bytes(std::int64_t model_id);
  // Layers whose tiles must be counted anew, since an edit was journalled without their sums.
  Result<std::vector<Layer>> layers_to_sum();
  // What all tiles of the layer hold that hold anything. Nobody may be editing it.
  Result<void> keep_sums(std::int64_t layer_id, std::vector<TileKeys> tiles);

  // --- answers to changing HTTP calls, by Idempotency-Key; kept for 7 days
  Result<std::optional<nlohmann::json>> find_answer(const std::string& key);

  // --- people: accounts, sessions and tokens
  Result<std::vector<Person>> people();       // by name
  Result<bool> administrator_has_password();  // so that somebody can sign in who may let in others
  Result<Person> person(const std::string& name);
  // Those of these names, exactly as written, whether they may sign in or not, and who is deleted.
  // In no order.
  Result<std::vector<Person>> people_called(const std::vector<std::string>& names);
  // invalid: no name for signing in: 1 to 64 of letters, digits and `._@-`, a letter or digit
  // first. conflict: it is taken, in whatever case, or of the form that is kept for who is deleted
  // (`former-7`). They are in these groups at once (invalid: there is no such group; conflict: it
  // is full), by whom the projects' activity tells; empty: it does not.
  Result<Person> create_person(const std::string& name, const std::string& full_name, Role role,
                               const std::vector<std::int64_t>& groups = {},
                               const std::string& by = {});
  // Who is disabled is signed out everywhere, and their invitations are worthless.
  Result<Person> change_person(std::int64_t id, const PersonChange& change);
  // Their account ends, and what they did stays under a name that tells nothing, here and in all
  // journals. Disable them first.
  Result<void> delete_person(const std::string& name);
  // Who has a role in the project beside the one they have everywhere, by name.
  Result<std::vector<Membership>> members(std::int64_t project_id);
  // Gives the role (viewer, annotator or curator) in place of the one they had there. not_found:
  // the project or the person is not there. `by`: who asked, for the project's activity; empty: it
  // is not told there.
  Result<Membership> put_member(std::int64_t project_id, const std::string& user, Role role,
                                const std::string& by = {});
  // How the person shows the layers of a model: `layers` of the protocol's PersonalView, with
  // layers by id, also those that are gone. Empty: as everybody sees them at first.
  Result<nlohmann::json> personal_view(const std::string& user, std::int64_t model_id);
  // In place of what was kept. too_large: more than a MiB.
  Result<void> keep_personal_view(const std::string& user, std::int64_t model_id,
                                  const nlohmann::json& layers);
  // A layer that everybody else does not see at first: this person does.
  Result<void> show_layer_to(const std::string& user, std::int64_t model_id, std::int64_t layer_id);
  // not_found: the person has no role of their own there.
  Result<void> remove_member(std::int64_t project_id, const std::string& user,
                             const std::string& by = {});
  // The hash (store/password.h); empty where there is none, or nobody of the name who may sign in.
  // In whatever case.
  Result<std::string> password_of(const std::string& name);
  // Ends all sessions but `kept`, and makes all links worthless.
  Result<void> set_password(const std::string& name, const std::string& hash,
                            std::optional<std::int64_t> kept);

  // A new one of somebody who may sign in (not_found: there is no such person). The oldest session
  // gives way where there are too many; tokens for scripts are refused then (conflict). With
  // `hash`: only while that is the person's password (unauthenticated). With `project`, for
  // scripts: good in that one alone (not_found: it is not there), as viewer, annotator or curator
  // (invalid).
  Result<NewToken> create_token(TokenKind kind, const std::string& user, Role role,
                                std::optional<std::chrono::seconds> lifetime,
                                const std::string& label = {},
                                const std::optional<std::string>& hash = {},
                                std::optional<std::int64_t> project = {});
  // The only good link of the kind that the person has: earlier ones become worthless.
  Result<NewToken> create_link(TokenKind kind, const std::string& user,
                               std::chrono::seconds lifetime);
  // Nothing: unknown, expired or revoked, or of somebody who may not sign in.
  Result<std::optional<Principal>> find_token(const std::string& secret);
  // Those that are good, the newest first.
  Result<std::vector<Token>> tokens(const std::string& user, TokenKind kind);
  // the secret of a session
  Result<std::optional<std::string>> redeem_owner_link(const std::string& link,
                                                       std::chrono::seconds lifetime,
                                                       const std::string& label = {});
  // Sets the password, uses the invitation up, and opens a session, whose secret is told. Nothing:
  // it is none.
  Result<std::optional<std::string>> accept_invitation(const std::string& invitation,
                                                       const std::string& hash,
                                                       const std::optional<std::string>& full_name,
                                                       std::chrono::seconds lifetime,
                                                       const std::string& label);
  Result<void> revoke_token(const std::string& secret);
  // not_found: the person has none of the kind with that id.
  Result<void> revoke_token(const std::string& user, TokenKind kind, std::int64_t id);
  Result<void> revoke_tokens(const std::string& user, TokenKind kind,
                             std::optional<std::int64_t> kept = {});

 private:
  Store();
  friend class JournalWriter;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::store
