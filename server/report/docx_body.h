#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "core/temporary_file.h"
#include "media/picture.h"
#include "report/document.h"

namespace strata::report {

struct DocxPicture {
  std::string name;          // of the part: "word/media/picture1.jpg"
  std::string relationship;  // the id by which the body refers to the part
  PictureFormat format = PictureFormat::png;
  PictureSource source;
  std::unique_ptr<TemporaryFile> converted;  // if set, replaces the source
};

struct DocxBody {
  std::string xml;  // the part word/document.xml
  std::vector<DocxPicture> pictures;
};

// The ids by which the body refers to other parts.
inline constexpr const char* kHeaderRelationship = "header";
inline constexpr const char* kFooterRelationship = "footer";

// Converts a document that `checked` returned to the main part of a .docx file. Reads all pictures.
// Writes converted pictures to files that begin with the name of `file`. Reports progress from 0 to
// `share`.
Result<DocxBody> docx_body(const Document& document, const std::filesystem::path& file,
                           Progress& progress, double share);

}  // namespace strata::report
