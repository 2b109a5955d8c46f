#include "store/files/files_mark.h"

#include <nlohmann/json.hpp>

namespace strata::store {

std::string to_text(const FilesMark& mark) {
  return nlohmann::json{{"format", 1}, {"id", to_string(mark.id)}, {"owner", mark.owner}}.dump() +
         "\n";
}

std::optional<FilesMark> parse_files_mark(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("id") || !json["id"].is_string()) return std::nullopt;
  const auto id = parse_uuid(json["id"].get<std::string>());
  if (!id) return std::nullopt;
  const auto owner = json.find("owner");
  return FilesMark{
      *id, owner != json.end() && owner->is_string() ? owner->get<std::string>() : std::string()};
}

}  // namespace strata::store
