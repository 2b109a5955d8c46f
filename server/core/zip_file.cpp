#include "core/zip_file.h"

#include <zip.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <exception>
#include <memory>

#include "core/overloaded.h"

namespace strata {
namespace {

struct DiscardZip {
  void operator()(zip_t* zip) const { zip_discard(zip); }
};
using Zip = std::unique_ptr<zip_t, DiscardZip>;

// Entries of a zip have a local time, so they get the first time that a zip can express.
constexpr zip_uint16_t kFirstTime = 0, kFirstDay = 1 << 5 | 1;  // 1980-01-01

constexpr zip_int64_t kWholeFile = -1;

// A content while it is made. libzip calls `answer` for it.
struct Pieces {
  const std::function<NextPiece()>& begin;
  const Progress& progress;
  NextPiece next{};
  std::string piece{};
  std::size_t used = 0;            // bytes of `piece`
  std::exception_ptr exception{};  // cannot pass through libzip

  // libzip asks is_cancelled only after contents of known size.
  zip_int64_t read(char* out, std::size_t bytes) {
    while (used == piece.size()) {
      if (progress.cancelled()) return -1;
      piece.clear();
      used = 0;
      if (!next(piece)) return 0;
    }
    const std::size_t count = std::min(bytes, piece.size() - used);
    std::memcpy(out, piece.data() + used, count);
    used += count;
    return static_cast<zip_int64_t>(count);
  }

  static zip_int64_t answer(void* state, void* data, zip_uint64_t bytes, zip_source_cmd_t command) {
    auto& pieces = *static_cast<Pieces*>(state);
    try {
      switch (command) {
        case ZIP_SOURCE_SUPPORTS:
          return zip_source_make_command_bitmap(ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE,
                                                ZIP_SOURCE_STAT, ZIP_SOURCE_ERROR, ZIP_SOURCE_FREE,
                                                -1);
        case ZIP_SOURCE_OPEN:
          pieces.next = pieces.begin();
          pieces.piece.clear();
          pieces.used = 0;
          return 0;
        case ZIP_SOURCE_READ: return pieces.read(static_cast<char*>(data), bytes);
        case ZIP_SOURCE_STAT:  // without a size, which is not known yet
          zip_stat_init(static_cast<zip_stat_t*>(data));
          return sizeof(zip_stat_t);
        case ZIP_SOURCE_ERROR: {
          const int codes[2] = {ZIP_ER_INTERNAL, 0};
          std::memcpy(data, codes, sizeof codes);
          return sizeof codes;
        }
        case ZIP_SOURCE_CLOSE:
        case ZIP_SOURCE_FREE: return 0;
        default: return -1;
      }
    } catch (...) {
      pieces.exception = std::current_exception();
      return -1;
    }
  }
};

tl::unexpected<Error> unwritable() {
  return fail(ErrorCode::storage_full, "File not written",
              "The disk of the server is full or not writable, so the file was not made. Free disk "
              "space.");
}

bool add(zip_t* zip, const ZipEntry& entry, zip_source_t* source) {
  if (source == nullptr) return false;
  const zip_int64_t index = zip_file_add(zip, entry.name.c_str(), source, ZIP_FL_ENC_UTF_8);
  if (index < 0) {
    zip_source_free(source);
    return false;
  }
  const auto added = static_cast<zip_uint64_t>(index);
  return zip_file_set_dostime(zip, added, kFirstTime, kFirstDay, 0) == 0 &&
         zip_set_file_compression(zip, added, entry.deflates ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 0) ==
             0;
}

}  // namespace

Result<void> write_zip(const std::vector<ZipEntry>& entries, const std::filesystem::path& file,
                       Progress& progress) {
  std::deque<Pieces> made;  // until the zip is closed
  int error = 0;
  Zip zip(zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error));
  if (!zip) return unwritable();
  for (const ZipEntry& entry : entries) {
    zip_source_t* source = std::visit(
        Overloaded{[&](std::span<const std::uint8_t> bytes) {
                     return zip_source_buffer(zip.get(), bytes.data(), bytes.size(), 0);
                   },
                   [&](const std::filesystem::path& path) {
                     return zip_source_file(zip.get(), path.c_str(), 0, kWholeFile);
                   },
                   [&](const std::function<NextPiece()>& begin) {
                     return zip_source_function(zip.get(), Pieces::answer,
                                                &made.emplace_back(Pieces{begin, progress}));
                   }},
        entry.content);
    if (!add(zip.get(), entry, source)) return unwritable();
  }
  const auto is_cancelled = [](zip_t*, void* state) {
    return static_cast<Progress*>(state)->cancelled() ? 1 : 0;
  };
  if (zip_register_cancel_callback_with_state(zip.get(), is_cancelled, nullptr, &progress) != 0)
    return unwritable();
  if (zip_close(zip.get()) != 0) {
    for (const Pieces& pieces : made)
      if (pieces.exception) std::rethrow_exception(pieces.exception);
    return progress.cancelled() ? cancelled_problem() : unwritable();
  }
  static_cast<void>(zip.release());  // zip_close has freed it
  return {};
}

}  // namespace strata
