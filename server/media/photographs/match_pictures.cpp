#include "media/photographs/match_pictures.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "core/text/ascii.h"
#include "media/photographs/pose_reader.h"

namespace strata::photo {
namespace {

std::string_view last_part(std::string_view path) { return path.substr(path.rfind('/') + 1); }

std::string_view without_extension(std::string_view name) {
  const auto dot = name.rfind('.');
  return dot == std::string_view::npos || dot == 0 ? name : name.substr(0, dot);
}

// The number of equal folders before the last part, from the end. Paths are in lower case.
std::size_t common_folders(std::string_view a, std::string_view b) {
  std::size_t count = 0;
  while (true) {
    const auto cut_a = a.rfind('/'), cut_b = b.rfind('/');
    if (cut_a == std::string_view::npos || cut_b == std::string_view::npos) return count;
    a = a.substr(0, cut_a);
    b = b.substr(0, cut_b);
    if (last_part(a) != last_part(b)) return count;
    ++count;
  }
}

struct Match {
  std::optional<std::size_t> index;  // none if several are equally close
  std::size_t folders = 0;
  bool is_found = false;

  void offer(std::size_t other, std::size_t common) {
    if (is_found && common < folders) return;
    index = is_found && common == folders ? std::nullopt : std::optional(other);
    folders = common;
    is_found = true;
  }
};

using Places = std::unordered_map<std::string_view, std::vector<std::size_t>>;

}  // namespace

std::vector<std::optional<std::size_t>> match_pictures(std::span<const std::string> photographs,
                                                       std::span<const std::string> pictures) {
  std::vector<std::string> paths;  // a view into these texts is the key of a place
  paths.reserve(pictures.size());
  for (const std::string& picture : pictures) paths.push_back(to_lower(photograph_name(picture)));
  Places by_name, by_stem;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    by_name[last_part(paths[i])].push_back(i);
    by_stem[without_extension(last_part(paths[i]))].push_back(i);
  }
  std::vector<Match> of_photographs(photographs.size()), of_pictures(pictures.size());
  for (std::size_t i = 0; i < photographs.size(); ++i) {
    const std::string path = to_lower(photographs[i]);
    const std::string_view name = last_part(path);
    auto found = by_name.find(name);
    const bool is_named = found != by_name.end();
    // A name without an extension may contain a point, so the whole name is also compared.
    if (!is_named) found = by_stem.find(name);
    if (!is_named && found == by_stem.end()) found = by_stem.find(without_extension(name));
    if (found == (is_named ? by_name : by_stem).end()) continue;
    for (const std::size_t picture : found->second)
      of_photographs[i].offer(picture, common_folders(path, paths[picture]));
    if (of_photographs[i].index)
      of_pictures[*of_photographs[i].index].offer(i, of_photographs[i].folders);
  }
  std::vector<std::optional<std::size_t>> out(photographs.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto& picture = of_photographs[i].index;
    if (picture && of_pictures[*picture].index == i) out[i] = picture;
  }
  return out;
}

}  // namespace strata::photo
