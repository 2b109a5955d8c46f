#include "net/api/linked/linked_page.h"

#include <algorithm>

#include "core/text/markup.h"
#include "vocabulary/rdf.h"

namespace strata::net {
namespace {

constexpr std::size_t kMostShown = 300;  // bytes of a text, such as a geometry

// Returns a link, and only the text for an address with another scheme, which may be unsafe.
std::string link(const std::string& address, const std::string& text) {
  if (!address.starts_with("http://") && !address.starts_with("https://"))
    return escaped_markup(text);
  return "<a href=\"" + escaped_markup(address) + "\">" + escaped_markup(text) + "</a>";
}

std::string shown_text(const nlohmann::json& value) {
  if (!value.is_string()) return escaped_markup(value.dump());
  const auto& text = value.get_ref<const std::string&>();
  if (is_iri(text)) return link(text, text);
  if (text.size() <= kMostShown) return escaped_markup(text);
  return "<details><summary>" + std::to_string(text.size()) + " characters</summary>" +
         escaped_markup(text) + "</details>";
}

// Returns the text by which people know a node.
std::string label_of(const nlohmann::json& node) {
  for (const char* member : {"_label", "title", "preferred_label", "label", "name", "content"})
    if (const auto found = node.find(member); found != node.end() && found->is_string())
      return found->get<std::string>();
  return {};
}

std::string shown(const nlohmann::json& value);

// Returns the name of a member as words: "referred to by".
std::string words_of(std::string member) {
  std::ranges::replace(member, '_', ' ');
  return escaped_markup(member.starts_with(' ') ? member.substr(1) : member);
}

std::string members_of(const nlohmann::json& node) {
  std::string rows;
  for (const auto& [member, value] : node.items())
    rows += "<tr><th scope=\"row\">" + words_of(member) + "</th><td>" + shown(value) + "</td></tr>";
  return rows.empty() ? rows : "<table><tbody>" + rows + "</tbody></table>";
}

// Returns the text of a node without an address: "Surface: 0.25 m²".
std::string text_of_blank(const nlohmann::json& node) {
  std::string text = escaped_markup(node.value("_label", std::string()));
  for (const char* member : {"content", "value"})
    if (const auto found = node.find(member); found != node.end())
      text = (text.empty() ? text : text + ": ") + shown_text(*found);
  if (const auto unit = node.find("unit"); unit != node.end())
    text += " " + escaped_markup(unit->value("_label", std::string()));
  return text;
}

std::string shown_node(const nlohmann::json& node) {
  nlohmann::json rest = node;
  std::string text;
  if (node.contains("id")) {
    const std::string address = node.at("id").get<std::string>(), label = label_of(node);
    text = link(address, label.empty() ? address : label);
    for (const char* member : {"id", "_label", "title", "type"}) rest.erase(member);
  } else {
    text = text_of_blank(node);
    if (node.contains("_label") || node.contains("content")) rest.erase("type");
    for (const char* member : {"_label", "content", "value", "unit"}) rest.erase(member);
  }
  if (const auto format = rest.find("format"); format != rest.end()) {
    text += " <small>" + shown_text(*format) + "</small>";
    rest.erase("format");
  }
  return text + members_of(rest);
}

std::string shown(const nlohmann::json& value) {
  if (value.is_array() && value.size() == 1) return shown(value.front());
  if (value.is_array()) {
    std::string list = "<ul>";
    for (const nlohmann::json& one : value) list += "<li>" + shown(one) + "</li>";
    return list + "</ul>";
  }
  if (!value.is_object()) return shown_text(value);
  if (value.contains("@value"))
    return escaped_markup(value.at("@value").get<std::string>()) + " <small>" +
           escaped_markup(value.at("@language").get<std::string>()) + "</small>";
  return shown_node(value);
}

}  // namespace

std::string linked_page(const nlohmann::json& document, const std::string& address,
                        const std::string& page) {
  nlohmann::json rest = document;
  rest.erase("id");
  const std::string label = label_of(document),
                    title = escaped_markup(label.empty() ? address : label);
  return "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width\">"
         "<link rel=\"icon\" href=\"/favicon.svg\" type=\"image/svg+xml\"><title>" +
         title + "</title><link rel=\"stylesheet\" href=\"/problems.css\"></head><body><main><h1>" +
         title + "</h1><p>" +
         (page.empty() ? std::string() : link(page, "Open in Strata") + " · ") +
         link(address + "?f=jsonld", "JSON-LD") + " · " + link(address + "?f=turtle", "Turtle") +
         "</p><p>Cite this address: <code>" + escaped_markup(address) + "</code></p>" +
         members_of(rest) + "</main></body></html>";
}

}  // namespace strata::net
