#include "net/api/docs_page.h"

#include <fstream>
#include <initializer_list>

#include "protocol/problem.h"

namespace strata::net {
namespace {

using nlohmann::json;

std::string text_of(const json& object, const char* member) {
  auto found = object.find(member);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// Follows "#/components/…/Name"; the object itself when it is no reference.
const json& resolve(const json& contract, const json& object) {
  const std::string reference = text_of(object, "$ref");
  if (!reference.starts_with("#/")) return object;
  const json::json_pointer pointer(reference.substr(1));
  return contract.contains(pointer) ? contract.at(pointer) : object;
}

std::string last_part(const std::string& reference) {
  return reference.substr(reference.rfind('/') + 1);
}

std::string type_of(const json& schema) {
  if (schema.contains("$ref")) {
    const std::string name = last_part(text_of(schema, "$ref"));
    return "<a href=\"#schema-" + html_escape(name) + "\">" + html_escape(name) + "</a>";
  }
  if (schema.contains("const")) return "<code>" + html_escape(schema["const"].dump()) + "</code>";
  if (schema.contains("enum")) {
    std::string text;
    for (const auto& value : schema["enum"])
      text += (text.empty() ? "<code>" : " | <code>") + html_escape(value.dump()) + "</code>";
    return text;
  }
  for (const char* choice : {"oneOf", "anyOf"}) {
    if (!schema.contains(choice) || schema.contains("properties")) continue;
    std::string text;
    for (const auto& item : schema[choice]) text += (text.empty() ? "" : " | ") + type_of(item);
    return text;
  }
  std::string type = text_of(schema, "type");
  if (type == "array" && schema.contains("items")) return "list of " + type_of(schema["items"]);
  if (auto format = text_of(schema, "format"); !format.empty()) type += " (" + format + ")";
  return html_escape(type.empty() ? "any" : type);
}

std::string content_of(const json& contract, const json& holder) {
  const json& object = resolve(contract, holder);
  std::string text;
  if (auto content = object.find("content"); content != object.end())
    for (const auto& [media, entry] : content->items()) {
      text += " <code>" + html_escape(media) + "</code>";
      if (entry.contains("schema")) text += " " + type_of(entry["schema"]);
    }
  return text;
}

std::string table_of(std::initializer_list<const char*> heads, const std::string& rows) {
  std::string table = "<table><thead><tr>";
  for (const char* head : heads) table += std::string("<th scope=\"col\">") + head + "</th>";
  return table + "</tr></thead><tbody>" + rows + "</tbody></table>";
}

void add_operation(std::string& page, const json& contract, const std::string& path,
                   const std::string& method, const json& operation,
                   const json& shared_parameters) {
  page += "<section class=\"operation\"><h3><span class=\"method " + html_escape(method) + "\">" +
          html_escape(method) + "</span> <code>" + html_escape(path) + "</code></h3>";
  if (auto summary = text_of(operation, "summary"); !summary.empty())
    page += "<p><strong>" + html_escape(summary) + "</strong></p>";
  if (auto description = text_of(operation, "description"); !description.empty())
    page += "<p>" + html_escape(description) + "</p>";
  std::string rows;
  for (const json* list : {&shared_parameters,
                           operation.contains("parameters") ? &operation["parameters"] : nullptr}) {
    if (!list || !list->is_array()) continue;
    for (const auto& entry : *list) {
      const json& parameter = resolve(contract, entry);
      rows += "<tr><td><code>" + html_escape(text_of(parameter, "name")) + "</code></td><td>" +
              html_escape(text_of(parameter, "in")) + "</td><td>" +
              (parameter.contains("schema") ? type_of(parameter["schema"]) : "") + "</td><td>" +
              html_escape(text_of(parameter, "description")) + "</td></tr>";
    }
  }
  if (!rows.empty()) page += table_of({"parameter", "in", "type", "description"}, rows);
  if (operation.contains("requestBody"))
    page += "<p>Body:" + content_of(contract, operation["requestBody"]) + "</p>";
  if (auto responses = operation.find("responses"); responses != operation.end()) {
    page += "<ul>";
    for (const auto& [status, response] : responses->items())
      page += "<li><code>" + html_escape(status) + "</code> " +
              html_escape(text_of(resolve(contract, response), "description")) +
              content_of(contract, response) + "</li>";
    page += "</ul>";
  }
  page += "</section>";
}

void add_schema(std::string& page, const std::string& name, const json& schema) {
  page += "<section class=\"schema\"><h3 id=\"schema-" + html_escape(name) + "\">" +
          html_escape(name) + "</h3>";
  for (const char* member : {"title", "description"})
    if (auto text = text_of(schema, member); !text.empty())
      page += "<p>" + html_escape(text) + "</p>";
  auto properties = schema.find("properties");
  if (properties == schema.end()) {
    page += "<p>" + type_of(schema) + "</p></section>";
    return;
  }
  std::string rows;
  for (const auto& [member, entry] : properties->items()) {
    bool required = false;
    if (auto list = schema.find("required"); list != schema.end())
      for (const auto& item : *list) required = required || item == member;
    rows += "<tr><td><code>" + html_escape(member) + "</code>" +
            (required ? "" : " <em>optional</em>") + "</td><td>" + type_of(entry) + "</td><td>" +
            html_escape(text_of(entry, "description")) + "</td></tr>";
  }
  page += table_of({"member", "type", "description"}, rows) + "</section>";
}

std::string begin_of_page(const std::string& title) {
  return "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width\">"
         "<link rel=\"icon\" href=\"/favicon.svg\" type=\"image/svg+xml\"><title>" +
         html_escape(title) +
         "</title><link rel=\"stylesheet\" href=\"/api/v1/docs.css\"></head><body><main>";
}

}  // namespace

std::string html_escape(std::string_view text) {
  std::string out;
  for (char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\'': out += "&#39;"; break;
      default: out += c;
    }
  }
  return out;
}

std::string docs_html(const json& contract) {
  const json info = contract.value("info", json::object());
  std::string page = begin_of_page(info.value("title", "API")) + "<h1>" +
                     html_escape(info.value("title", "API")) + " <small>" +
                     html_escape(info.value("version", "")) + "</small></h1>";
  if (auto description = text_of(info, "description"); !description.empty())
    page += "<p>" + html_escape(description) + "</p>";
  page +=
      "<p>The same as a file: <a href=\"/api/v1/openapi.json\">openapi.json</a></p><h2>Addresses</h2>";
  const json paths = contract.value("paths", json::object());
  for (const auto& [path, item] : paths.items()) {
    const json shared = item.value("parameters", json::array());
    for (const auto& [method, operation] : item.items())
      if (operation.is_object() && operation.contains("responses"))
        add_operation(page, contract, path, method, operation, shared);
  }
  const json schemas =
      contract.value("components", json::object()).value("schemas", json::object());
  if (!schemas.empty()) page += "<h2>Objects</h2>";
  for (const auto& [name, schema] : schemas.items()) add_schema(page, name, schema);
  return page + "</main></body></html>";
}

std::string problems_html() {
  std::string page = begin_of_page("Problems of the Strata API") +
                     "<h1>Problems of the Strata API</h1><p>Every error is an "
                     "<code>application/problem+json</code> (RFC 9457). Its <code>type</code> is "
                     "one of these; programs decide by it. The words of <code>title</code> and "
                     "<code>detail</code> may change.</p><table><thead><tr><th>Type</th>"
                     "<th>Status</th><th>Meaning</th><th>What to do</th></tr></thead><tbody>";
  for (const protocol::ProblemKind& kind : protocol::problem_kinds()) {
    const std::string code(name(kind.code));
    page += "<tr id=\"" + code + "\"><td><code>" + protocol::problem_type(kind.code) +
            "</code></td><td>" + std::to_string(kind.status) + "</td><td>" +
            html_escape(kind.meaning) + "</td><td>" + html_escape(kind.remedy) + "</td></tr>";
  }
  return page + "</tbody></table></main></body></html>";
}

Result<Response> docs_page(const std::filesystem::path& openapi_json) {
  std::ifstream file(openapi_json, std::ios::binary);
  const json contract = json::parse(file, nullptr, false);
  if (contract.is_discarded() || !contract.is_object())
    return fail(ErrorCode::unavailable, "Contract missing",
                "openapi.json is not part of this installation.");
  return text_response(docs_html(contract), "text/html; charset=utf-8");
}

std::string_view docs_style() {
  return R"(body{font:16px/1.5 system-ui,sans-serif;max-width:64rem;margin:2rem auto;padding:0 1rem;color:#222;background:#fbfaf8}
h1 small{color:#767067;font-weight:400}code{font-family:ui-monospace,monospace;font-size:.92em}
section{border-top:1px solid #ddd6cb;padding:.5rem 0}h3{margin:.4rem 0;font-weight:600}
.method{display:inline-block;min-width:4.2rem;text-transform:uppercase;font-size:.8rem;letter-spacing:.05em;color:#7a3b12}
table{border-collapse:collapse;margin:.5rem 0}td,th{text-align:left;vertical-align:top;padding:.2rem .9rem .2rem 0}
th{color:#5d574e;font-weight:500}em{color:#767067;font-size:.85em}a{color:#14568a}
@media(prefers-color-scheme:dark){body{color:#ddd;background:#1c1a17}section{border-color:#3b3730}a{color:#8ec3ee}.method{color:#e0a070}th,em,h1 small{color:#a79f92}}
)";
}

}  // namespace strata::net
