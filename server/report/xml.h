#pragma once

#include <pugixml.hpp>
#include <string>

namespace strata::report {

// Returns the text of an XML document, in UTF-8 and without added white space.
std::string xml_text(const pugi::xml_document& document);

// Appends the declaration and the first element of a document.
pugi::xml_node begin_xml(pugi::xml_document& document, const char* element);

template <class Value>
pugi::xml_node set(pugi::xml_node node, const char* attribute, const Value& value) {
  if constexpr (std::is_same_v<Value, std::string>)
    node.append_attribute(attribute).set_value(value.c_str());
  else
    node.append_attribute(attribute).set_value(value);
  return node;
}

// Appends an element with an attribute `w:val`, as WordprocessingML has many.
template <class Value>
pugi::xml_node add_value(pugi::xml_node parent, const char* element, const Value& value) {
  return set(parent.append_child(element), "w:val", value);
}

// Appends an element that contains a text.
pugi::xml_node add_text(pugi::xml_node parent, const char* element, const std::string& text);

// Appends a text to a run of WordprocessingML, which has a separate element for each line end.
void add_lines(pugi::xml_node run, const std::string& text);

}  // namespace strata::report
