#include "jobs/companions.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/mapped_file.h"
#include "core/text/ascii.h"

namespace strata::jobs {
namespace {

namespace fs = std::filesystem;

// The largest size of a material library, of a glTF's JSON and of a PLY's header.
constexpr std::size_t kMaxText = std::size_t{64} << 20;

// Characters to remove around names, which may be in quotation marks.
constexpr std::string_view kAroundNames = " \t\r\"";

// Returns the file that `reference` names, as a path relative to the folder.
std::optional<fs::path> below(const fs::path& folder, std::string_view reference) {
  std::string slashes(reference);
  std::ranges::replace(slashes, '\\', '/');
  const fs::path named = fs::path(slashes).lexically_normal();
  std::error_code error;
  for (const fs::path& relative : {named, named.filename()}) {
    const bool inside = !relative.empty() && relative.is_relative() && *relative.begin() != "..";
    if (inside && fs::is_regular_file(folder / relative, error)) return relative;
  }
  return std::nullopt;
}

// Returns the longest end of the line that names a file, because names may contain spaces and may
// follow options.
std::optional<fs::path> file_at_end(const fs::path& folder, std::string_view words) {
  for (words = trimmed(words, kAroundNames); !words.empty(); words = trimmed(words, kAroundNames)) {
    if (auto file = below(folder, words)) return file;
    const auto space = words.find_first_of(" \t");
    if (space == std::string_view::npos) return std::nullopt;
    words.remove_prefix(space);
  }
  return std::nullopt;
}

// Passes the rest of a line to `take` if `is_relevant` accepts the line's first word.
void each_line(std::string_view text, const std::function<bool(const std::string&)>& is_relevant,
               const std::function<void(std::string_view)>& take) {
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    const auto word_end = std::min(line.find_first_of(" \t"), line.size());
    if (word_end > 0 && word_end < 32 && is_relevant(to_lower(line.substr(0, word_end))))
      take(line.substr(word_end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

struct Collector {
  fs::path folder;
  std::vector<fs::path> found;

  bool add(const std::optional<fs::path>& file) {
    if (!file || std::ranges::find(found, *file) != found.end()) return false;
    found.push_back(*file);
    return true;
  }

  void add_textures(const fs::path& library) {
    const auto text = MappedFile::open(folder / library);
    if (!text || text->view().size() > kMaxText) return;
    const auto is_map = [](const std::string& word) {
      return word.starts_with("map_") || word == "norm" || word == "bump";
    };
    each_line(text->view(), is_map, [&](std::string_view rest) { add(file_at_end(folder, rest)); });
  }

  void add_obj(std::string_view text) {
    each_line(
        text, [](const std::string& word) { return word == "mtllib"; },
        [&](std::string_view rest) {
          if (auto library = file_at_end(folder, rest); add(library)) add_textures(*library);
        });
  }

  void add_ply(std::string_view text) {
    const std::string_view header =
        text.substr(0, std::min(text.find("end_header"), std::min(text.size(), kMaxText)));
    each_line(
        header, [](const std::string& word) { return word == "comment"; },
        [&](std::string_view rest) {
          rest = trimmed(rest, kAroundNames);
          if (to_lower(rest.substr(0, 11)) == "texturefile")
            add(file_at_end(folder, rest.substr(11)));
        });
  }

  void add_gltf(std::string_view text) {
    const auto json =
        nlohmann::json::parse(text.substr(0, std::min(text.size(), kMaxText)), nullptr, false);
    if (!json.is_object()) return;
    for (const char* list : {"buffers", "images"}) {
      const auto entries = json.find(list);
      if (entries == json.end() || !entries->is_array()) continue;
      for (const auto& entry : *entries) {
        if (!entry.is_object() || !entry.contains("uri") || !entry["uri"].is_string()) continue;
        const std::string uri = entry["uri"];
        if (!uri.starts_with("data:")) add(below(folder, decoded(uri)));
      }
    }
  }

  static std::string decoded(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
      const auto digit = [&](std::size_t at) {
        return at < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[at]));
      };
      if (uri[i] == '%' && digit(i + 1) && digit(i + 2)) {
        text += static_cast<char>(std::stoi(std::string(uri.substr(i + 1, 2)), nullptr, 16));
        i += 2;
      } else {
        text += uri[i];
      }
    }
    return text;
  }
};

}  // namespace

std::vector<mesh::InputFile> with_companions(const fs::path& mesh) {
  std::vector<mesh::InputFile> files{{mesh.filename().string(), mesh}};
  Collector companions{mesh.has_parent_path() ? mesh.parent_path() : fs::path("."), {}};
  const auto kind = mesh::input_kind(files[0].filename);
  if (kind != mesh::InputKind::obj && kind != mesh::InputKind::ply && kind != mesh::InputKind::gltf)
    return files;
  const auto content = MappedFile::open(mesh);
  if (!content) return files;
  if (kind == mesh::InputKind::obj) companions.add_obj(content->view());
  if (kind == mesh::InputKind::ply) companions.add_ply(content->view());
  if (kind == mesh::InputKind::gltf) companions.add_gltf(content->view());
  for (const fs::path& file : companions.found)
    files.push_back({file.generic_string(), companions.folder / file});
  return files;
}

}  // namespace strata::jobs
