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

class Blobs;
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

// Files in the cells of picture and document columns. Files are read and written as streams. Part
// of Store, whose rules for threads and errors apply.
class Attachments {
 public:
  Attachments(Pool& pool, Blobs& blobs) : pool_(pool), blobs_(blobs) {}

  // Appends all files or none to the cell of a record, as one entry of the journal. If no column is
  // given, uses the first picture column if all files are pictures, otherwise the first document
  // column.
  Result<Attached> attach(TableId table_id, std::int64_t key, std::optional<ColumnId> column_id,
                          const std::vector<NewAttachment>& files,
                          std::optional<std::int64_t> version, const Author& who,
                          const IdempotentResponse<Attached>& answer = {});
  // Removes the attachment from all cells that list it. Returns a `not_found` error if no cell
  // lists it. The file is kept for undo and for past states.
  Result<TableChange> detach(AttachmentId attachment_id, const std::string& user,
                             const IdempotentResponse<TableChange>& answer = {});
  // Returns a `not_found` error for an attachment that `seen_by` cannot see.
  Result<Attachment> find(AttachmentId id, const Author& seen_by);
  // Returns the attachments with these ids that the table has and `seen_by` can see, sorted by id.
  Result<std::vector<Attachment>> of_table(TableId table_id, const Author& seen_by,
                                           std::span<const AttachmentId> ids);
  Result<Attachment> show(AttachmentId id, Visibility visibility,
                          const IdempotentResponse<Attachment>& answer = {});
  // Reads the content with this hash (hexadecimal), of an attachment, a file of a tour or a
  // photograph. Passes the bytes from `begin` up to, but not including, `end` to `sink`, in pieces
  // of at most 1 MiB. `sink` returns false to stop.
  Result<void> read(const std::string& sha256, std::uint64_t begin, std::uint64_t end,
                    const std::function<bool(std::span<const std::uint8_t>)>& sink);
  // Thumbnails are stored after they are made. All files with the same content share them.
  Result<std::optional<std::vector<std::uint8_t>>> thumbnail(const std::string& sha256, int side);
  Result<void> keep_thumbnail(const std::string& sha256, int side,
                              std::span<const std::uint8_t> picture);
  // Deletes the contents that no model, surface image or attachment uses, and returns their number.
  // Called at start and after a table is deleted.
  Result<std::int64_t> drop_orphans();

 private:
  Pool& pool_;
  Blobs& blobs_;
};

}  // namespace strata::store
