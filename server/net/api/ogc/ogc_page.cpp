#include "net/api/ogc/ogc_page.h"

#include <nlohmann/json.hpp>

#include "core/text/markup.h"
#include "net/api/ogc/ogc_request.h"

namespace strata::net {
namespace {

std::string text_in(const nlohmann::json& object, const char* member) {
  const auto found = object.find(member);
  return found != object.end() && found->is_string() ? escaped_markup(found->get<std::string>())
                                                     : std::string();
}

// Returns the address of a link as a page, if the server has one.
std::string href_of(const nlohmann::json& link) {
  const std::string href = link.value("href", std::string());
  const bool is_page = link.value("type", std::string()) == "application/json";
  return escaped_markup(is_page ? with_query(href, "f=html") : href);
}

std::string anchor(const std::string& href, const std::string& text) {
  return "<a href=\"" + href + "\">" + text + "</a>";
}

std::string link_list(const nlohmann::json& links) {
  std::string list = "<h2>Links</h2><ul>";
  for (const auto& link : links) {
    const std::string relation = link.at("rel"), title = text_in(link, "title");
    // `self` and `alternate` are the forms of this document, whose addresses have a format. Queries
    // for values need parameters, so their addresses are only shown.
    const bool is_form = relation == "self" || relation == "alternate";
    list += "<li>" +
            (link.contains("variables")
                 ? title + ": <code>" + text_in(link, "href") + "</code>"
                 : anchor(is_form ? text_in(link, "href") : href_of(link), title)) +
            " <small>" + text_in(link, "type") + "</small></li>";
  }
  return list + "</ul>";
}

std::string collection_table(const nlohmann::json& collections) {
  std::string table =
      "<h2>Collections</h2><table><thead><tr><th scope=\"col\">Id</th><th scope=\"col\">Title</th>"
      "<th scope=\"col\">Description</th></tr></thead><tbody>";
  for (const auto& collection : collections)
    table += "<tr><td>" +
             anchor(href_of(collection.at("links").front()), text_in(collection, "id")) +
             "</td><td>" + text_in(collection, "title") + "</td><td>" +
             text_in(collection, "description") + "</td></tr>";
  return table + "</tbody></table>";
}

}  // namespace

std::string ogc_page(const nlohmann::json& document) {
  const std::string title =
      document.contains("title") ? text_in(document, "title") : std::string("Strata");
  std::string page =
      "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width\">"
      "<link rel=\"icon\" href=\"/favicon.svg\" type=\"image/svg+xml\"><title>" +
      title + "</title><link rel=\"stylesheet\" href=\"/problems.css\"></head><body><main><h1>" +
      title + "</h1><p>" + text_in(document, "description") + "</p>";
  if (document.contains("crs") && document.at("crs").is_array()) {
    page += "<h2>Coordinate systems</h2><ul>";
    for (const auto& system : document.at("crs"))
      page += "<li><code>" + escaped_markup(system.get<std::string>()) + "</code></li>";
    page += "</ul>";
  }
  if (document.contains("collections")) page += collection_table(document.at("collections"));
  if (document.contains("conformsTo")) {
    page += "<ul>";
    for (const auto& item : document.at("conformsTo"))
      page += "<li><code>" + escaped_markup(item.get<std::string>()) + "</code></li>";
    page += "</ul>";
  }
  return page + link_list(document.at("links")) + "</main></body></html>";
}

}  // namespace strata::net
