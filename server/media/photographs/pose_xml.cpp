#include "media/photographs/pose_xml.h"

#include <algorithm>

namespace strata::photo {
namespace {

std::size_t line_at(const PoseFile& file, std::ptrdiff_t offset) {
  if (offset < 0) return 0;
  const auto text = text_of(file).substr(0, static_cast<std::size_t>(offset));
  return 1 + static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

}  // namespace

Result<void> parse_pose_xml(pugi::xml_document& document, const PoseFile& file) {
  const auto is_part = [](char c) { return c == '<' || c == '='; };
  if (static_cast<std::size_t>(std::ranges::count_if(text_of(file), is_part)) > kMaxPoseXmlParts)
    return fail(ErrorCode::too_large, "Camera poses too large",
                "The XML has too many elements. Export only the cameras, without markers and "
                "points.",
                "files");
  const auto parsed =
      document.load_buffer(file.bytes.data(), file.bytes.size(),
                           pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
  for (const pugi::xml_node node : document.children())
    if (node.type() == pugi::node_doctype)
      return wrong_pose(file, line_of(file, node),
                        "the XML has a document type, which no export of cameras has. Remove it.");
  if (!parsed)
    return wrong_pose(file, line_at(file, parsed.offset),
                      std::string(parsed.description()) +
                          ". The XML is damaged or incomplete. Export the cameras again.");
  return {};
}

std::size_t line_of(const PoseFile& file, const pugi::xml_node& node) {
  return line_at(file, node.offset_debug());
}

}  // namespace strata::photo
