// Writes documents as Office Open XML. A .docx is a zip file of XML parts (ISO/IEC 29500-1,
// clause 11).
#include <memory>
#include <span>
#include <vector>

#include "core/temporary_file.h"
#include "core/zip_file.h"
#include "report/check_document.h"
#include "report/docx_body.h"
#include "report/docx_parts.h"
#include "report/unwritable.h"
#include "report/writers.h"

namespace strata::report {
namespace {

ZipEntry entry_of(const DocxPicture& picture) {
  ZipEntry entry{.name = picture.name, .content = {}, .deflates = false};
  if (picture.converted)
    entry.content = picture.converted->path;
  else if (const auto* file = std::get_if<std::filesystem::path>(&picture.source))
    entry.content = *file;
  else
    entry.content = std::span<const std::uint8_t>(
        *std::get<std::shared_ptr<const std::vector<std::uint8_t>>>(picture.source));
  return entry;
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

Result<void> write(const Document& requested, const std::filesystem::path& file,
                   Progress& progress) {
  constexpr double kBodyShare = 0.7;
  const Document document = STRATA_TRY(checked(requested));
  const DocxBody body = STRATA_TRY(docx_body(document, file, progress, kBodyShare));
  if (progress.cancelled()) return cancelled_problem();
  progress.report(kBodyShare, "Writing the file");
  const std::vector<DocxPart> parts = docx_parts(document, body);
  std::vector<ZipEntry> entries;
  for (const DocxPart& part : parts)
    entries.push_back({.name = part.name, .content = bytes_of(part.content)});
  for (const DocxPicture& picture : body.pictures) entries.push_back(entry_of(picture));
  // All entries have the same time. The document contains its time in the core properties.
  return write_zip(entries, file, progress);
}

}  // namespace

Result<void> write_docx(const Document& document, const std::filesystem::path& file,
                        Progress& progress) {
  return without_exceptions(file, [&] { return write(document, file, progress); });
}

}  // namespace strata::report
