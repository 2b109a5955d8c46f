#pragma once

#include <pugixml.hpp>

#include "media/photographs/pose_reader.h"

namespace strata::photo {

// Parses the XML of an export into `document`. Returns an `invalid` error for a document type,
// because entities need one, and for syntax errors. Returns `too_large` for more than
// kMaxPoseXmlParts, so that the tree of the document needs less than half a gigabyte.
constexpr std::size_t kMaxPoseXmlParts = 6'000'000;  // beginnings and ends of elements, attributes
Result<void> parse_pose_xml(pugi::xml_document& document, const PoseFile& file);

// Returns the line where a node of the parsed document begins.
std::size_t line_of(const PoseFile& file, const pugi::xml_node& node);

}  // namespace strata::photo
