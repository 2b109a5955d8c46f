#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "core/ids.h"
#include "domain/people/visibility.h"

namespace strata {

// A file that belongs to records of a table. The content never changes.
struct Attachment {
  AttachmentId id = 0;
  TableId table_id = 0;
  std::string name;        // a file name without folders
  std::string media_type;  // determined from the bytes of the file
  std::uint64_t bytes = 0;
  std::string sha256;  // hexadecimal
  // Of a readable image, before the rotation that its Exif data requests.
  std::optional<int> width, height;
  std::string user;
  std::chrono::system_clock::time_point time;
  Visibility visibility = Visibility::everyone;
};

// Follows the visibility (domain/people/visibility.h). Annotators also see the files that they
// attached.
inline bool sees(const Author& who, const Attachment& attachment) {
  return sees(who.role, attachment.visibility) ||
         (who.role >= Role::annotator && who.user == attachment.user);
}

}  // namespace strata
