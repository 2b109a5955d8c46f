#include "store/files/content.h"

#include <algorithm>
#include <fstream>

#include "core/progress.h"

namespace strata::store {
namespace {

// Calls `visit` with each chunk of a file.
Result<void> each_chunk_of_file(const std::filesystem::path& file,
                                const std::function<Result<void>(Bytes)>& visit) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    return fail(ErrorCode::internal, "File not readable", "Cannot open " + file.string() + ".",
                "source_files");
  std::vector<std::uint8_t> buffer(kChunkBytes);
  for (;;) {
    in.read(reinterpret_cast<char*>(buffer.data()), static_cast<std::streamsize>(buffer.size()));
    if (in.bad())
      return fail(ErrorCode::internal, "File not readable", "Cannot read " + file.string() + ".",
                  "source_files");
    const auto size = static_cast<std::size_t>(in.gcount());
    if (size == 0) return {};
    STRATA_TRY(visit(Bytes(buffer).first(size)));
  }
}

}  // namespace

Sha256 sha256_of(Bytes hash) {
  Sha256 copy{};
  std::copy_n(hash.begin(), std::min(hash.size(), copy.size()), copy.begin());
  return copy;
}

Content content_of(Bytes memory) {
  return {sha256(memory), static_cast<std::int64_t>(memory.size()), memory, {}};
}

Result<Content> content_of(const std::filesystem::path& file,
                           const std::function<bool()>& cancelled) {
  Sha256Stream stream;
  Content content;
  content.file = file;
  STRATA_TRY(each_chunk_of_file(file, [&](Bytes chunk) -> Result<void> {
    if (cancelled && cancelled()) return cancelled_problem();
    stream.add(chunk);
    content.bytes += static_cast<std::int64_t>(chunk.size());
    return {};
  }));
  content.hash = stream.finish();
  return content;
}

Result<void> each_chunk(const Content& content, const std::function<bool()>& cancelled,
                        const std::function<Result<void>(Bytes)>& sink) {
  if (content.file.empty()) {
    for (Bytes rest = content.memory; !rest.empty();) {
      if (cancelled && cancelled()) return cancelled_problem();
      const Bytes chunk = rest.first(std::min(rest.size(), kChunkBytes));
      STRATA_TRY(sink(chunk));
      rest = rest.subspan(chunk.size());
    }
    return {};
  }
  Sha256Stream stream;
  STRATA_TRY(each_chunk_of_file(content.file, [&](Bytes chunk) -> Result<void> {
    if (cancelled && cancelled()) return cancelled_problem();
    stream.add(chunk);
    return sink(chunk);
  }));
  if (stream.finish() != content.hash)
    return fail(ErrorCode::conflict, "File changed",
                content.file.string() + " changed while it was read. Import it again.",
                "source_files");
  return {};
}

Result<std::vector<std::uint8_t>> chunk_sums_of(const Content& content,
                                                const std::function<bool()>& cancelled) {
  std::vector<std::uint8_t> sums;
  STRATA_TRY(each_chunk(content, cancelled, [&](Bytes chunk) -> Result<void> {
    const Sha256 sum = sha256(chunk);
    sums.insert(sums.end(), sum.begin(), sum.end());
    return {};
  }));
  return sums;
}

}  // namespace strata::store
