#include "mesh/io/file_comments.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/text/ascii.h"
#include "core/text/utf8.h"

namespace strata::mesh {
namespace {

constexpr std::size_t kHead = 256 * 1024;  // the part of a file that is searched for comments
constexpr std::size_t kStlHeader = 80;

bool is_blank_or_control(char c) { return static_cast<unsigned char>(c) <= ' '; }

class Comments {
 public:
  void add(std::string_view text) {
    std::string clean(text);
    std::ranges::replace_if(clean, is_blank_or_control, ' ');
    text = trimmed(clean).substr(0, kMaxCommentLength);
    if (text.empty() || list_.size() >= kMaxComments) return;
    list_.push_back(mended_utf8(text));
  }
  std::vector<std::string> take() { return std::move(list_); }

 private:
  std::vector<std::string> list_;
};

// Calls `use` for each line of the head of a file until `use` returns false. Lines may have any
// line endings.
template <class Use>
void each_line(std::string_view head, Use&& use) {
  while (!head.empty()) {
    const std::size_t end = head.find_first_of("\r\n");
    if (!use(trimmed(head.substr(0, end))) || end == std::string_view::npos) return;
    head.remove_prefix(end + 1);
  }
}

void read_ply(std::string_view head, Comments& comments) {
  each_line(head, [&](std::string_view line) {
    for (const std::string_view keyword : {"comment", "obj_info"})
      if (line.starts_with(keyword) && line.size() > keyword.size() &&
          is_blank_or_control(line[keyword.size()]))
        comments.add(line.substr(keyword.size()));
    return line != "end_header";
  });
}

// Comments after the first element describe groups and are not read.
void read_obj(std::string_view head, Comments& comments) {
  each_line(head, [&](std::string_view line) {
    if (line.starts_with('#'))
      comments.add(line.substr(std::min(line.find_first_not_of('#'), line.size())));
    return !line.starts_with("f ") && !line.starts_with("v ");
  });
}

void read_stl(std::string_view head, Comments& comments) {
  const bool is_text = head.find("facet") < kHead && head.starts_with("solid");
  comments.add(is_text ? head.substr(0, head.find_first_of("\r\n")) : head.substr(0, kStlHeader));
}

// Returns the words of a text in lower case. A word consists of letters and digits. A hyphen before
// the word is kept.
std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words(1);
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
  for (const char raw : text) {
    const char c = raw >= 'A' && raw <= 'Z' ? static_cast<char>(raw - 'A' + 'a') : raw;
    if (is_letter(c)) {
      words.back() += c;
      continue;
    }
    if (!words.back().empty()) words.emplace_back();
    if (c == '-') words.back().assign(1, c);
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

// Removes a hyphen that joins two words, because it is not a minus sign.
std::string unsigned_word(const std::string& word) {
  return word.starts_with('-') ? word.substr(1) : word;
}

struct UnitName {
  std::string_view name;
  std::optional<Unit> unit;
};
constexpr UnitName kUnitNames[] = {{"mm", Unit::mm},
                                   {"millimeter", Unit::mm},
                                   {"millimeters", Unit::mm},
                                   {"millimetre", Unit::mm},
                                   {"millimetres", Unit::mm},
                                   {"cm", Unit::cm},
                                   {"centimeter", Unit::cm},
                                   {"centimeters", Unit::cm},
                                   {"centimetre", Unit::cm},
                                   {"centimetres", Unit::cm},
                                   {"m", Unit::m},
                                   {"meter", Unit::m},
                                   {"meters", Unit::m},
                                   {"metre", Unit::m},
                                   {"metres", Unit::m},
                                   {"inch", {}},
                                   {"inches", {}},
                                   {"in", {}},
                                   {"feet", {}},
                                   {"foot", {}},
                                   {"ft", {}},
                                   {"um", {}},
                                   {"micron", {}},
                                   {"microns", {}},
                                   {"km", {}},
                                   {"yards", {}}};

// Returns true for words allowed between "unit" and the name of the unit.
bool is_filler(std::string_view word) {
  for (const std::string_view filler :
       {"is", "are", "of", "length", "lengths", "measure", "measurement", "name"})
    if (word == filler) return true;
  return false;
}

std::optional<std::string> axis_of(const std::string& word) {
  const std::string axis = unsigned_word(word);
  return axis == "x" || axis == "y" || axis == "z" ? std::optional(word) : std::nullopt;
}

std::string opposite(std::string axis) {
  if (axis.starts_with('-'))
    axis.erase(0, 1);
  else
    axis.insert(axis.begin(), '-');
  return axis;
}

std::optional<std::string> up_in(const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = unsigned_word(words[i]);
    if (word == "up" || word == "down") {
      std::size_t after = i + 1;
      while (after < words.size() && (words[after] == "axis" || words[after] == "direction" ||
                                      words[after] == "vector" || words[after] == "is"))
        ++after;
      auto axis = i > 0 ? axis_of(words[i - 1]) : std::nullopt;
      if (!axis && after < words.size()) axis = axis_of(words[after]);
      if (axis) return word == "up" ? *axis : opposite(*axis);
    }
    if (word == "upaxis" && i + 1 < words.size())
      if (auto axis = axis_of(words[i + 1])) return axis;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> file_comments(const InputFiles& files) {
  const auto bytes = files.scan().bytes;
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()),
                              std::min(bytes.size(), kHead));
  Comments comments;
  switch (input_kind(files.scan().name)) {
    case InputKind::ply: read_ply(head, comments); break;
    case InputKind::obj: read_obj(head, comments); break;
    case InputKind::stl: read_stl(head, comments); break;
    default: break;
  }
  return comments.take();
}

std::optional<Stated<Unit>> stated_unit(std::span<const std::string> comments) {
  for (const std::string& comment : comments) {
    if (comment.starts_with("TextureFile")) continue;
    const auto words = words_of(comment);
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::string word = unsigned_word(words[i]);
      if (word != "unit" && word != "units") continue;
      std::size_t after = i + 1;
      while (after < words.size() && is_filler(words[after])) ++after;
      if (after == words.size()) continue;
      const auto* named =
          std::ranges::find(kUnitNames, std::string_view(words[after]), &UnitName::name);
      if (named == std::end(kUnitNames)) continue;
      return named->unit ? std::optional(Stated<Unit>{*named->unit, comment}) : std::nullopt;
    }
  }
  return std::nullopt;
}

std::optional<Stated<std::string>> stated_up(std::span<const std::string> comments) {
  for (const std::string& comment : comments)
    if (auto up = up_in(words_of(comment))) return Stated<std::string>{*up, comment};
  return std::nullopt;
}

}  // namespace strata::mesh
