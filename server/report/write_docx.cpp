// Writes documents as Office Open XML. A .docx is a zip file of XML parts (ISO/IEC 29500-1,
// clause 11).
#include <zip.h>

#include <cmath>
#include <exception>
#include <fstream>
#include <memory>
#include <sstream>
#include <vector>

#include "core/temporary_file.h"
#include "report/check_document.h"
#include "report/docx_body.h"
#include "report/docx_parts.h"
#include "report/unwritable.h"
#include "report/writers.h"

namespace strata::report {
namespace {

struct DiscardZip {
  void operator()(zip_t* zip) const { zip_discard(zip); }
};
using Zip = std::unique_ptr<zip_t, DiscardZip>;

// Entries of a zip have a local time, so they get the first time that a zip can express. The
// document contains its time in the core properties.
constexpr zip_uint16_t kFirstTime = 0, kFirstDay = 1 << 5 | 1;  // 1980-01-01

constexpr zip_int64_t kWholeFile = -1;

bool add(zip_t* zip, const std::string& name, zip_source_t* source, bool deflates) {
  if (source == nullptr) return false;
  const zip_int64_t index = zip_file_add(zip, name.c_str(), source, ZIP_FL_ENC_UTF_8);
  if (index < 0) {
    zip_source_free(source);
    return false;
  }
  const auto entry = static_cast<zip_uint64_t>(index);
  return zip_file_set_dostime(zip, entry, kFirstTime, kFirstDay, 0) == 0 &&
         zip_set_file_compression(zip, entry, deflates ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 0) == 0;
}

zip_source_t* source_of(zip_t* zip, const DocxPicture& picture) {
  if (picture.converted)
    return zip_source_file(zip, picture.converted->path.c_str(), 0, kWholeFile);
  if (const auto* file = std::get_if<std::filesystem::path>(&picture.source))
    return zip_source_file(zip, file->c_str(), 0, kWholeFile);
  const auto& bytes = *std::get<std::shared_ptr<const std::vector<std::uint8_t>>>(picture.source);
  return zip_source_buffer(zip, bytes.data(), bytes.size(), 0);
}

Result<void> write(const Document& requested, const std::filesystem::path& file,
                   Progress& progress) {
  constexpr double kBodyShare = 0.7;
  const Document document = STRATA_TRY(checked(requested));
  const DocxBody body = STRATA_TRY(docx_body(document, file, progress, kBodyShare));
  if (progress.cancelled()) return cancelled_problem();
  progress.report(kBodyShare, "Writing the file");
  int error = 0;
  Zip zip(zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error));
  if (!zip) return unwritable();
  const std::vector<DocxPart> parts = docx_parts(document, body);
  for (const DocxPart& part : parts)
    if (!add(zip.get(), part.name,
             zip_source_buffer(zip.get(), part.content.data(), part.content.size(), 0), true))
      return unwritable();
  for (const DocxPicture& picture : body.pictures)
    if (!add(zip.get(), picture.name, source_of(zip.get(), picture), false)) return unwritable();
  const auto is_cancelled = [](zip_t*, void* state) {
    return static_cast<Progress*>(state)->cancelled() ? 1 : 0;
  };
  if (zip_register_cancel_callback_with_state(zip.get(), is_cancelled, nullptr, &progress) != 0)
    return unwritable();
  if (zip_close(zip.get()) != 0) return progress.cancelled() ? cancelled_problem() : unwritable();
  static_cast<void>(zip.release());  // zip_close has freed it
  return {};
}

}  // namespace

Result<void> write_docx(const Document& document, const std::filesystem::path& file,
                        Progress& progress) {
  return without_exceptions(file, [&] { return write(document, file, progress); });
}

}  // namespace strata::report
