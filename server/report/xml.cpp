#include "report/xml.h"

#include <algorithm>
#include <sstream>

namespace strata::report {

std::string xml_text(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, "", pugi::format_raw, pugi::encoding_utf8);
  return text.str();
}

pugi::xml_node begin_xml(pugi::xml_document& document, const char* element) {
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  set(declaration, "version", "1.0");
  set(declaration, "encoding", "UTF-8");
  set(declaration, "standalone", "yes");
  return document.append_child(element);
}

pugi::xml_node add_text(pugi::xml_node parent, const char* element, const std::string& text) {
  pugi::xml_node node = parent.append_child(element);
  node.append_child(pugi::node_pcdata).set_value(text.c_str());
  return node;
}

void add_lines(pugi::xml_node run, const std::string& text) {
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (at > 0) run.append_child("w:br");
    if (end > at) set(add_text(run, "w:t", text.substr(at, end - at)), "xml:space", "preserve");
    at = end + 1;
  }
}

}  // namespace strata::report
