#pragma once

#include <string>
#include <vector>

#include "report/docx_body.h"

namespace strata::report {

struct DocxPart {
  std::string name, content;
};

// Returns all parts of a .docx file except its pictures, in the order in which they are stored.
std::vector<DocxPart> docx_parts(const Document& document, const DocxBody& body);

}  // namespace strata::report
