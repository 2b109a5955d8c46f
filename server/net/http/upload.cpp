#include "net/http/upload.h"

#include <fstream>

#include "core/mapped_file.h"
#include "core/text/filename.h"
#include "core/uuid.h"
#include "net/http/form_files.h"

namespace strata::net {
namespace {

namespace fs = std::filesystem;

// Copies a part of the form to a separate file.
Result<Upload> keep_part(const FormFile& part, const fs::path& folder, const MappedFile& form) {
  constexpr std::size_t kWindowBytes = 4u << 20;
  Upload upload{folder / (to_string(random_uuid()) + ".part"), part.filename};
  std::ofstream out(upload.file, std::ios::binary);
  for (std::size_t at = 0; at < part.content.size() && out; at += kWindowBytes) {
    const std::string_view window = part.content.substr(at, kWindowBytes);
    out.write(window.data(), static_cast<std::streamsize>(window.size()));
    form.release(window);
  }
  out.close();
  if (out) return upload;
  std::error_code ignored;
  fs::remove(upload.file, ignored);
  return fail(ErrorCode::storage_full, "Disk full",
              "The server could not store the upload on its disk. Ask an administrator to "
              "free disk space.");
}

Result<std::vector<Upload>> keep_parts(std::string_view content_type, const MappedFile& form,
                                       const fs::path& folder, const char* accepted) {
  const auto parts = STRATA_TRY(files_of_form(
      content_type, form.view(), [&](std::string_view passed) { form.release(passed); }));
  if (parts.empty()) return fail(ErrorCode::unsupported, "No file in the form", accepted, "body");
  std::vector<Upload> uploads;
  for (const FormFile& part : parts) {
    auto upload = keep_part(part, folder, form);
    if (!upload) {
      std::error_code ignored;
      for (const Upload& stored : uploads) fs::remove(stored.file, ignored);
      return tl::unexpected(upload.error());
    }
    uploads.push_back(std::move(*upload));
  }
  return uploads;
}

}  // namespace

Result<std::vector<Upload>> take_upload(const Request& request, const fs::path& folder,
                                        const char* accepted) {
  const auto mapped = MappedFile::open(request.body_file);
  if (!mapped || mapped->view().empty())
    return fail(ErrorCode::malformed, "Empty body", accepted, "body");
  const std::string type = to_lower(request.header("content-type"));
  if (type.starts_with("multipart/form-data"))
    return keep_parts(request.header("content-type"), *mapped, folder, accepted);
  if (type.starts_with("multipart/"))
    return fail(ErrorCode::unsupported, "Invalid form", accepted, "Content-Type");
  std::string name =
      base_filename(header_parameter(request.header("content-disposition"), "filename"));
  if (name.empty() && type.starts_with("application/zip")) name = "scan.zip";
  return std::vector<Upload>{{request.body_file, std::move(name)}};
}

UploadedFiles::~UploadedFiles() {
  std::error_code gone_already;
  for (const Upload& upload : uploads_)
    if (upload.file != body_) std::filesystem::remove(upload.file, gone_already);
}

}  // namespace strata::net
