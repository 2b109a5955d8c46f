#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "net/http/http_types.h"

namespace strata::net {

struct Upload {
  std::filesystem::path file;
  // The sender's file name with its folders. Empty if the sender gives no name.
  std::string filename;
};

// Deletes the extracted files of a form when the response has been sent.
class UploadedFiles {
 public:
  UploadedFiles(const std::vector<Upload>& uploads, const std::filesystem::path& body)
      : uploads_(uploads), body_(body) {}
  UploadedFiles(const UploadedFiles&) = delete;
  ~UploadedFiles();

 private:
  const std::vector<Upload>& uploads_;
  const std::filesystem::path& body_;  // the body of the request
};

constexpr const char* kScanUpload =
    "Send the scan as the body (PLY, OBJ, STL, glTF, GLB, LAS, or a zip of one scan with its textures), or the mesh and its "
    "material and picture files together in a multipart/form-data form.";

// Returns the files of a request whose body is in a file. A file is the body itself or a part of a
// multipart/form-data body (net/http/form_files). Copies each part to a separate file in `folder`.
// After an error, no such file remains there. `accepted` is the detail of the error for a body
// without a file.
Result<std::vector<Upload>> take_upload(const Request& request, const std::filesystem::path& folder,
                                        const char* accepted = kScanUpload);

}  // namespace strata::net
