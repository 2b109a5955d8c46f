#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "domain/tables/attachment.h"
#include "store/content/idempotent_response.h"
#include "store/tables/table_changes.h"

namespace strata::store {

class Pool;

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

// Files that cells of picture and document columns list, streamed both ways. Part of Store: its
// rules for threads and errors hold.
class Attachments {
 public:
  explicit Attachments(Pool& pool) : pool_(pool) {}

  // Appends them to a record's cell, as one entry of the journal, or nothing at all. Without a
  // column: the first one of pictures where all of them are that, otherwise the first one of
  // documents.
  Result<Attached> attach(TableId table_id, std::int64_t key, std::optional<ColumnId> column_id,
                          const std::vector<NewAttachment>& files,
                          std::optional<std::int64_t> version, const Author& who,
                          const IdempotentResponse<Attached>& answer = {});
  // Takes it out of all cells that list it; `not_found` where none does. It stays for undo and for
  // reading the past.
  Result<TableChange> detach(AttachmentId attachment_id, const std::string& user,
                             const IdempotentResponse<TableChange>& answer = {});
  // One that they do not see is not found.
  Result<Attachment> find(AttachmentId id, const Author& seen_by);
  // Those of the ids that the table has and they see, by id.
  Result<std::vector<Attachment>> of_table(TableId table_id, const Author& seen_by,
                                           std::span<const AttachmentId> ids);
  Result<Attachment> show(AttachmentId id, Visibility visibility,
                          const IdempotentResponse<Attachment>& answer = {});
  // The bytes from `begin` to before `end`, in pieces ≤ 1 MiB; `sink` returns false to stop.
  Result<void> read(const Attachment& attachment, std::uint64_t begin, std::uint64_t end,
                    const std::function<bool(std::span<const std::uint8_t>)>& sink);
  // Small pictures, kept once made; all attachments of one content share them.
  Result<std::optional<std::vector<std::uint8_t>>> thumbnail(const Attachment& attachment,
                                                             int side);
  Result<void> keep_thumbnail(const Attachment& attachment, int side,
                              std::span<const std::uint8_t> picture);
  // Deletes contents that no model, look or attachment has any more, and tells how many they were.
  // At start and after a table is deleted.
  Result<std::int64_t> drop_orphans();

 private:
  Pool& pool_;
};

}  // namespace strata::store
