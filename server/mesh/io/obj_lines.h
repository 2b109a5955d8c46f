#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "mesh/io/text_number.h"

namespace strata::mesh {

// The logical lines of an OBJ. Lines end with LF, CRLF or CR. A line that ends with a backslash
// continues on the next line. Comments are not removed here.
class ObjLines {
 public:
  explicit ObjLines(std::span<const std::uint8_t> bytes)
      : at_(reinterpret_cast<const char*>(bytes.data())), begin_(at_), end_(at_ + bytes.size()) {}

  // `line` is valid until the next call.
  bool next(std::string_view& line) {
    if (at_ == end_) return false;
    line_number_ += lines_of_last_;
    lines_of_last_ = 1;
    line = physical_line();
    if (!continues(line)) return true;
    joined_.clear();
    while (continues(line)) {
      joined_.append(line.data(), line.find_last_of('\\'));
      joined_ += ' ';
      if (at_ == end_) {
        line = {};
        break;
      }
      line = physical_line();
      ++lines_of_last_;
    }
    joined_.append(line);
    line = joined_;
    return true;
  }

  std::uint64_t line_number() const { return line_number_; }  // of the first physical line, from 1
  double fraction() const {
    return begin_ == end_ ? 1.0
                          : static_cast<double>(at_ - begin_) / static_cast<double>(end_ - begin_);
  }

 private:
  // Lines end with LF, CRLF or a single CR. The position of the next LF is stored. A file with CR
  // only is therefore not searched for LF at each line.
  std::string_view physical_line() {
    const char* start = at_;
    if (start >= newline_) {
      const void* found = start == end_
                              ? nullptr
                              : std::memchr(start, '\n', static_cast<std::size_t>(end_ - start));
      newline_ = found ? static_cast<const char*>(found) : end_;
    }
    const void* found = start == newline_
                            ? nullptr
                            : std::memchr(start, '\r', static_cast<std::size_t>(newline_ - start));
    const char* stop = found ? static_cast<const char*>(found) : newline_;
    at_ = stop == end_ ? end_ : stop + 1;
    if (found && at_ == newline_ && at_ != end_) ++at_;  // CRLF
    return {start, static_cast<std::size_t>(stop - start)};
  }
  static bool continues(std::string_view line) { return !line.empty() && line.back() == '\\'; }

  const char* at_;
  const char* begin_;
  const char* end_;
  // the next LF, or end_; searched again when at_ has reached it
  const char* newline_ = begin_;
  std::uint64_t line_number_ = 1;
  std::uint64_t lines_of_last_ = 0;
  std::string joined_;
};

// Removes the next word from the front of `line`. Returns an empty word at the end of the line or
// at a comment.
inline std::string_view next_word(std::string_view& line) {
  std::size_t start = 0;
  while (start < line.size() && is_blank(line[start])) ++start;
  std::size_t end = start;
  while (end < line.size() && !is_blank(line[end])) ++end;
  std::string_view word = line.substr(start, end - start);
  line.remove_prefix(end);
  if (!word.empty() && word.front() == '#') {
    line = {};
    word = {};
  }
  return word;
}

}  // namespace strata::mesh
