#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "mesh/io/face_builder.h"
#include "mesh/io/load_formats.h"
#include "mesh/io/plain_text.h"
#include "mesh/io/text_number.h"

namespace strata::mesh {
namespace {

constexpr std::size_t kHeaderBytes = 80, kTriangleBytes = 50;
constexpr std::uint64_t kTrianglesBetweenReports = 65536;
constexpr std::size_t kSample = 65536;

// Every triangle has its own three points. `repair` joins equal points.
class StlReader {
 public:
  StlReader(std::span<const std::uint8_t> bytes, Progress& progress, std::size_t max_triangles)
      : bytes_(bytes), plain_(bytes), progress_(progress), faces_(loaded_.mesh, max_triangles) {}

  // Many binary files begin with "solid", as text files do, and text files may begin with any text.
  // A file with exactly the size of a binary file is binary. Otherwise it is binary if it contains
  // bytes that do not occur in text.
  Result<LoadedMesh> read() {
    const auto count = binary_count();
    const std::uint64_t room = count ? (bytes_.size() - kHeaderBytes - 4) / kTriangleBytes : 0;
    const bool fits = count && *count <= room && *count > 0;
    const bool exact = fits && bytes_.size() == kHeaderBytes + 4 + *count * kTriangleBytes;
    const bool text = !exact && (is_all_text() || (!fits && has_words_of_text()));
    STRATA_TRY(text ? read_text() : read_binary(count, room));
    faces_.report(loaded_.repairs);
    return std::move(loaded_);
  }

 private:
  std::optional<std::uint64_t> binary_count() const {
    if (bytes_.size() < kHeaderBytes + 4) return std::nullopt;
    std::uint32_t count;
    std::memcpy(&count, bytes_.data() + kHeaderBytes, sizeof count);
    return count;
  }

  // Text may have any encoding. In a binary file, the count or the coordinates contain zero bytes.
  bool is_all_text() const {
    const std::string_view sample = text_.substr(0, kSample);
    return std::none_of(sample.begin(), sample.end(), [](char c) {
      return static_cast<unsigned char>(c) < 32 && !is_blank(c) && c != kEndOfDosFile;
    });
  }
  // Some writers pad a name with zero bytes, so this function searches for words.
  bool has_words_of_text() const {
    bool facet = false;
    std::string_view rest = text_.substr(0, kSample);
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      if (facet && is_word(word, "vertex")) return true;
      facet |= is_word(word, "facet");
    }
    return false;
  }

  Result<void> read_binary(std::optional<std::uint64_t> count, std::uint64_t room) {
    if (!count)
      return refuse_file(
          "This is not an STL file: it is not text, and it is shorter than the header of "
          "a binary STL.");
    if (*count > room)
      return refuse_file(
          "The binary STL declares " + std::to_string(*count) + " triangles, but contains only " +
          std::to_string(room) +
          ": it is incomplete, or it is not an STL file. Export or upload it again.");
    if (*count == 0) return refuse_file("The binary STL contains no triangle: it is empty.");
    loaded_.mesh.positions.reserve(3 * *count);
    faces_.reserve(*count);
    const std::uint8_t* at = bytes_.data() + kHeaderBytes + 4;
    for (std::uint64_t i = 0; i < *count; ++i, at += kTriangleBytes) {
      if (i % kTrianglesBetweenReports == 0 && !report(double(i) / double(*count)))
        return cancelled_problem();
      std::array<float, 9> p;
      std::memcpy(p.data(), at + 12, sizeof p);
      if (auto added = add({glm::dvec3(p[0], p[1], p[2]), glm::dvec3(p[3], p[4], p[5]),
                            glm::dvec3(p[6], p[7], p[8])});
          !added)
        return added;
    }
    note(loaded_.repairs, "ignored bytes after the last element",
         bytes_.size() - kHeaderBytes - 4 - *count * kTriangleBytes);
    return {};
  }

  // solid NAME { facet normal x y z  outer loop  vertex x y z ×3  endloop  endfacet } endsolid, in
  // upper or lower case. Only the vertices are used.
  Result<void> read_text() {
    std::vector<glm::dvec3> loop;
    std::string_view rest = text_;
    bool any_word = false;
    for (std::uint64_t n = 0;; ++n) {
      if (n % kTrianglesBetweenReports == 0 &&
          !report(1 - double(rest.size()) / double(std::max<std::size_t>(text_.size(), 1))))
        return cancelled_problem();
      const std::string_view word = next_word(rest);
      if (word.empty()) break;
      if (begins_comment(word)) {
        skip_line(rest);
      } else if (is_word(word, "solid") || is_word(word, "endsolid")) {
        // a name may be any text
        any_word = true;
        skip_line(rest);
      } else if (is_word(word, "vertex")) {
        any_word = true;
        glm::dvec3 point(0);
        const std::string_view numbers = rest;
        for (int k = 0; k < 3; ++k)
          if (!parse_number(next_word(rest), point[k]))
            return fault(numbers, "a vertex without three numbers");
        if (loop.size() == kMaxPolygonCorners) return FaceBuilder::too_many_corners(place(rest));
        loop.push_back(point);
      } else if (is_word(word, "endfacet") || is_word(word, "endloop")) {
        STRATA_TRY(add(loop));
        loop.clear();
      } else if (is_word(word, "facet")) {
        any_word = true;
        if (!loop.empty()) return fault(rest, "a facet without an end");
      }
    }
    if (!loop.empty())
      return refuse_file(
          "The STL ends within a facet: the file is incomplete. Export or upload it again.");
    if (!any_word) return refuse_file("This is not an STL file: it is text without a facet.");
    if (loaded_.mesh.triangles.empty())
      return refuse_file("The text STL contains no triangle: it is empty.");
    return {};
  }

  Result<void> add(std::span<const glm::dvec3> loop) {
    if (loop.empty()) return {};
    if (loaded_.mesh.positions.size() + loop.size() >= 0xffffffffu)
      return refuse_file("The file has more than 4 294 967 294 vertices. Split the mesh.");
    corners_.clear();
    for (const glm::dvec3& point : loop) {
      corners_.push_back({static_cast<std::uint32_t>(loaded_.mesh.positions.size())});
      loaded_.mesh.positions.push_back(point);
    }
    return faces_.add(corners_, false);
  }
  Result<void> add(std::initializer_list<glm::dvec3> loop) {
    return add(std::span(loop.begin(), loop.size()));
  }

  static std::string_view next_word(std::string_view& rest) {
    std::size_t start = 0;
    while (start < rest.size() && is_blank(rest[start])) ++start;
    std::size_t end = start;
    while (end < rest.size() && !is_blank(rest[end])) ++end;
    const std::string_view word = rest.substr(start, end - start);
    rest.remove_prefix(end);
    return word;
  }

  static bool is_word(std::string_view word, std::string_view lower) {
    return std::equal(word.begin(), word.end(), lower.begin(), lower.end(), [](char a, char b) {
      return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
    });
  }
  static bool begins_comment(std::string_view word) {
    return word.front() == '#' || word.front() == ';' || word.front() == '!' ||
           word.starts_with("//");
  }
  static void skip_line(std::string_view& rest) {
    rest.remove_prefix(std::min(rest.find_first_of("\r\n"), rest.size()));
  }

  // Lines end with LF, CRLF or a single CR.
  std::string place(std::string_view rest) const {
    const auto read = text_.substr(0, text_.size() - rest.size());
    std::uint64_t line = 1;
    for (std::size_t i = 0; i < read.size(); ++i)
      line += read[i] == '\n' || (read[i] == '\r' && text_.substr(i + 1, 1) != "\n");
    return "line " + std::to_string(line);
  }
  tl::unexpected<Error> fault(std::string_view rest, const std::string& what) const {
    return refuse_file("The STL file has " + what + " at " + place(rest) +
                       ". It is damaged or incomplete.");
  }

  bool report(double share) {
    progress_.report(kParsedShare * share, "Reading triangles");
    return !progress_.cancelled();
  }

  static constexpr char kEndOfDosFile = 0x1a;

  const std::span<const std::uint8_t> bytes_;
  const PlainText plain_;
  const std::string_view text_{reinterpret_cast<const char*>(plain_.bytes().data()),
                               plain_.bytes().size()};
  Progress& progress_;
  LoadedMesh loaded_;
  FaceBuilder faces_;
  std::vector<FaceBuilder::Corner> corners_;
};

}  // namespace

Result<LoadedMesh> parse_stl(const InputFiles& files, Progress& progress,
                             std::size_t max_triangles) {
  return StlReader(files.scan().bytes, progress, max_triangles).read();
}

}  // namespace strata::mesh
