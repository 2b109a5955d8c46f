#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "net/http/http_types.h"

namespace strata::net {

struct Upload {
  std::filesystem::path file;
  // the sender's name with its folders; empty if the sender gives none
  std::string filename;
};

// Holds the extracted parts of a form until the answer is sent, and then deletes them.
class UploadedFiles {
 public:
  UploadedFiles(const std::vector<Upload>& uploads, const std::filesystem::path& body)
      : uploads_(uploads), body_(body) {}
  UploadedFiles(const UploadedFiles&) = delete;
  ~UploadedFiles();

 private:
  const std::vector<Upload>& uploads_;
  const std::filesystem::path& body_;  // belongs to the request
};

constexpr const char* kScanUpload =
    "Send the scan as the body (PLY, OBJ, STL, glTF, GLB, or a zip of one scan with its textures), or the mesh and its "
    "material and picture files together in a multipart/form-data form.";

// Returns the files of a request whose body is in a file: the body itself, or the files of a
// multipart/form-data body (net/http/form_files), each copied to a separate file in `folder`; after
// an Error no file remains there. `accepted`: the detail of the error for a body without a file.
Result<std::vector<Upload>> take_upload(const Request& request, const std::filesystem::path& folder,
                                        const char* accepted = kScanUpload);

}  // namespace strata::net
