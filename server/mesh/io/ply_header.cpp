#include "mesh/io/ply_header.h"

#include <algorithm>
#include <cstring>

#include "mesh/io/load_formats.h"
#include "mesh/io/plain_text.h"
#include "mesh/io/text_number.h"

namespace strata::mesh {
namespace {

constexpr std::size_t kMaxHeader = std::size_t{16} << 20;
constexpr std::size_t kMaxElements = 1000;
constexpr std::size_t kMaxProperties = 1000;
constexpr std::size_t kMaxTextureFiles = 4096;

std::optional<PlyType> parse_type(std::string_view name) {
  struct Entry {
    std::string_view name;
    PlyType type;
  };
  static constexpr Entry kTypes[] = {
      {"char", PlyType::i8},    {"int8", PlyType::i8},     {"uchar", PlyType::u8},
      {"uint8", PlyType::u8},   {"short", PlyType::i16},   {"int16", PlyType::i16},
      {"ushort", PlyType::u16}, {"uint16", PlyType::u16},  {"int", PlyType::i32},
      {"int32", PlyType::i32},  {"uint", PlyType::u32},    {"uint32", PlyType::u32},
      {"float", PlyType::f32},  {"float32", PlyType::f32}, {"double", PlyType::f64},
      {"float64", PlyType::f64}};
  for (const Entry& entry : kTypes) {
    if (entry.name == name) return entry.type;
  }
  return std::nullopt;
}

bool is_integer(PlyType type) { return type != PlyType::f32 && type != PlyType::f64; }

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < line.size();) {
    while (i < line.size() && is_blank(line[i])) ++i;
    std::size_t end = i;
    while (end < line.size() && !is_blank(line[end])) ++end;
    if (end > i) words.push_back(line.substr(i, end - i));
    i = end;
  }
  return words;
}

// Returns a short and printable piece of the file for a message.
std::string shown(std::string_view text) {
  std::string result = "\"";
  for (char c : text.substr(0, 60)) result += c >= ' ' && c < 127 ? c : '?';
  return result + "\"";
}

class HeaderReader {
 public:
  explicit HeaderReader(std::span<const std::uint8_t> bytes)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
        position_(utf8_mark(bytes)) {}

  Result<PlyHeader> read() {
    std::string_view line;
    if (!next_line(line) || split(line) != std::vector<std::string_view>{"ply"}) {
      return refuse_file("This is not a PLY file: its first line is not \"ply\".");
    }
    while (next_line(line)) {
      const auto words = split(line);
      if (words.empty()) continue;
      if (words[0] == "end_header") return finish();
      STRATA_TRY(read_line(words));
    }
    if (text_.size() - position_ > kMaxHeader || position_ > kMaxHeader)
      return refuse_file("The PLY has no \"end_header\" in its first 16 MB.");
    return refuse_file(
        "The PLY header has no \"end_header\": the file is incomplete, or it is not a "
        "PLY file.");
  }

 private:
  // All lines have the same ending as the first line. In old Macintosh files this is a single CR,
  // and an LF byte after "end_header" CR already belongs to the data. The CR of a CRLF is read as a
  // blank.
  bool next_line(std::string_view& line) {
    if (position_ >= text_.size() || position_ > kMaxHeader) return false;
    const std::string_view rest = text_.substr(position_, kMaxHeader);
    if (line_number_ == 0) {
      const std::size_t end = rest.find_first_of("\r\n");
      if (end != std::string_view::npos && rest[end] == '\r' && rest.substr(end + 1, 1) != "\n")
        line_end_ = '\r';
    }
    const std::size_t end = rest.find(line_end_);
    if (end == std::string_view::npos) return false;
    line = rest.substr(0, end);
    position_ += end + 1;
    ++line_number_;
    return true;
  }

  tl::unexpected<Error> fault(const std::string& what) const {
    return refuse_file("PLY header, line " + std::to_string(line_number_) + ": " + what);
  }

  Result<void> read_line(const std::vector<std::string_view>& words) {
    if (words[0] == "comment" || words[0] == "obj_info") {
      if (words.size() > 2 && words[1] == "TextureFile" &&
          header_.texture_files.size() < kMaxTextureFiles)
        header_.texture_files.emplace_back(words[2].data(),
                                           words.back().data() + words.back().size());
      return {};
    }
    if (words[0] == "format") return read_format(words);
    if (words[0] == "element") return read_element(words);
    if (words[0] == "property") return read_property(words);
    return fault("unknown keyword " + shown(words[0]) + ".");
  }

  Result<void> read_format(const std::vector<std::string_view>& words) {
    if (words.size() < 2) return fault("the format is missing.");
    if (words[1] == "ascii") {
      header_.encoding = PlyEncoding::ascii;
    } else if (words[1] == "binary_little_endian") {
      header_.encoding = PlyEncoding::little_endian;
    } else if (words[1] == "binary_big_endian") {
      header_.encoding = PlyEncoding::big_endian;
    } else {
      return fault("unknown format " + shown(words[1]) +
                   "; the server reads ascii, binary_little_endian and binary_big_endian.");
    }
    has_format_ = true;
    return {};
  }

  Result<void> read_element(const std::vector<std::string_view>& words) {
    PlyElement element;
    std::int64_t count = 0;
    if (words.size() != 3 || !parse_integer(words[2], count) || count < 0) {
      return fault("expected \"element NAME COUNT\" with a count of 0 or more.");
    }
    element.name = words[1];
    element.count = static_cast<std::uint64_t>(count);
    for (const PlyElement& other : header_.elements) {
      if (other.name == element.name)
        return fault("the element " + shown(words[1]) + " is declared twice.");
    }
    if (header_.elements.size() == kMaxElements) return fault("more than 1000 elements.");
    header_.elements.push_back(std::move(element));
    return {};
  }

  Result<void> read_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) return fault("a property before the first element.");
    const bool list = words.size() > 1 && words[1] == "list";
    if (words.size() != (list ? 5u : 3u)) {
      return fault("expected \"property TYPE NAME\" or \"property list TYPE TYPE NAME\".");
    }
    PlyProperty property;
    const auto type = parse_type(words[list ? 3 : 1]);
    if (!type) return fault("unknown type " + shown(words[list ? 3 : 1]) + ".");
    property.type = *type;
    if (list) {
      const auto count_type = parse_type(words[2]);
      if (!count_type || !is_integer(*count_type))
        return fault(shown(words[2]) + " cannot be the type of a list's count.");
      property.count_type = count_type;
    }
    property.name = words.back();
    auto& properties = header_.elements.back().properties;
    if (properties.size() >= kMaxProperties)
      return fault("more than 1000 properties in one element.");
    properties.push_back(std::move(property));
    return {};
  }

  // A header may declare any count. No memory is allocated for a count that the file cannot hold.
  Result<PlyHeader> finish() {
    if (!has_format_) return refuse_file("The PLY header has no \"format\" line.");
    header_.data_offset = position_;
    const bool ascii = header_.encoding == PlyEncoding::ascii;
    // the last value needs no blank after it
    std::uint64_t rest = text_.size() - position_ + (ascii ? 1 : 0);
    for (const PlyElement& element : header_.elements) {
      const std::uint64_t least = element.least_bytes(ascii);
      if (least > 0 && element.count > rest / least) {
        return refuse_file(
            "The header declares " + std::to_string(element.count) + " entries of the element " +
            shown(element.name) + ", but only " + std::to_string(rest) +
            " bytes are left for them. The file is incomplete, or its header is wrong.");
      }
      rest -= least * element.count;
    }
    return std::move(header_);
  }

  std::string_view text_;
  std::size_t position_;
  std::size_t line_number_ = 0;
  char line_end_ = '\n';
  bool has_format_ = false;
  PlyHeader header_;
};

}  // namespace

int bytes_of(PlyType type) {
  static constexpr int kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<int>(type)];
}

std::optional<int> PlyElement::find(std::initializer_list<std::string_view> names) const {
  for (std::string_view requested : names) {
    for (std::size_t i = 0; i < properties.size(); ++i) {
      if (properties[i].name == requested) return static_cast<int>(i);
    }
  }
  return std::nullopt;
}

std::uint64_t PlyElement::least_bytes(bool ascii) const {
  std::uint64_t sum = 0;
  for (const PlyProperty& property : properties)
    sum += ascii ? 2 : bytes_of(property.count_type.value_or(property.type));
  return sum;
}

std::uint64_t PlyHeader::element_count() const {
  std::uint64_t sum = 0;
  for (const PlyElement& element : elements)
    if (!element.properties.empty()) sum += element.count;  // each element takes bytes of the file
  return sum;
}

Result<PlyHeader> parse_ply_header(std::span<const std::uint8_t> bytes) {
  return HeaderReader(bytes).read();
}

}  // namespace strata::mesh
