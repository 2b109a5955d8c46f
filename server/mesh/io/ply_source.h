#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>

#include "mesh/io/ply_header.h"
#include "mesh/io/text_number.h"

namespace strata::mesh {

static_assert(std::endian::native == std::endian::little);

enum class PlyFault { none, end_of_file, not_a_number };

// Reads values one by one from binary or ASCII data. If a value cannot be read, the function
// returns false and does not advance.
class PlyBinarySource {
 public:
  PlyBinarySource(std::span<const std::uint8_t> bytes, std::size_t offset, bool big_endian)
      : begin_(bytes.data()),
        at_(bytes.data() + offset),
        end_(bytes.data() + bytes.size()),
        swap_(big_endian) {}

  bool value(PlyType type, double& result) {
    switch (type) {
      case PlyType::i8: return take<std::int8_t, std::uint8_t>(result);
      case PlyType::u8: return take<std::uint8_t, std::uint8_t>(result);
      case PlyType::i16: return take<std::int16_t, std::uint16_t>(result);
      case PlyType::u16: return take<std::uint16_t, std::uint16_t>(result);
      case PlyType::i32: return take<std::int32_t, std::uint32_t>(result);
      case PlyType::u32: return take<std::uint32_t, std::uint32_t>(result);
      case PlyType::f32: return take<float, std::uint32_t>(result);
      case PlyType::f64: return take<double, std::uint64_t>(result);
    }
    return false;
  }

  bool integer(PlyType type, std::int64_t& result) {
    switch (type) {
      case PlyType::u8: return take<std::uint8_t, std::uint8_t>(result);
      case PlyType::i32: return take<std::int32_t, std::uint32_t>(result);
      case PlyType::u32: return take<std::uint32_t, std::uint32_t>(result);
      default: break;
    }
    double number = 0;
    if (!value(type, number)) return false;
    if (!(std::abs(number) <= 9e15) || number != std::floor(number)) {
      at_ -= bytes_of(type);
      fault_ = PlyFault::not_a_number;
      return false;
    }
    result = static_cast<std::int64_t>(number);
    return true;
  }

  bool skip(PlyType type, std::uint64_t count) {
    const std::uint64_t size = bytes_of(type);
    if (count > rest() / size) return at_end();
    at_ += count * size;
    return true;
  }

  // Returns true if the remaining data can hold `count` items of a list.
  bool holds(PlyType type, std::uint64_t count) const {
    return count <= rest() / static_cast<std::uint64_t>(bytes_of(type));
  }

  void end_element() {}
  std::uint64_t surplus_elements() const { return 0; }

  std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
  std::uint64_t rest() const { return static_cast<std::uint64_t>(end_ - at_); }
  std::uint64_t bytes_left_over() { return rest(); }
  PlyFault fault() const { return fault_; }
  std::string place() const { return "byte " + std::to_string(offset()); }

 private:
  template <class Number, class Bits, class Target>
  bool take(Target& result) {
    if (rest() < sizeof(Number)) return at_end();
    Bits bits;
    std::memcpy(&bits, at_, sizeof bits);
    if (swap_) {
      if constexpr (sizeof(Bits) == 2) bits = __builtin_bswap16(bits);
      if constexpr (sizeof(Bits) == 4) bits = __builtin_bswap32(bits);
      if constexpr (sizeof(Bits) == 8) bits = __builtin_bswap64(bits);
    }
    at_ += sizeof(Number);
    result = static_cast<Target>(std::bit_cast<Number>(bits));
    return true;
  }
  bool at_end() {
    fault_ = PlyFault::end_of_file;
    return false;
  }

  const std::uint8_t* begin_;
  const std::uint8_t* at_;
  const std::uint8_t* end_;
  bool swap_;
  PlyFault fault_ = PlyFault::none;
};

// ASCII values are separated by blanks, not by lines, because some writers wrap long lists. If
// there are exactly as many lines as elements, the rest of a line after an element's last value is
// skipped. MeshLab writes more words than the header has properties.
class PlyAsciiSource {
 public:
  PlyAsciiSource(std::span<const std::uint8_t> bytes, const PlyHeader& header)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
        at_(header.data_offset),
        lines_hold_elements_(count_lines(header.element_count() + 1) == header.element_count()) {}

  bool value(PlyType, double& result) {
    const std::string_view word = next_word();
    if (word.empty()) return false;
    if (!parse_number(word, result)) return refuse(word);
    return true;
  }

  bool integer(PlyType, std::int64_t& result) {
    const std::string_view word = next_word();
    if (word.empty()) return false;
    if (parse_integer(word, result)) return true;
    double number = 0;  // some files contain "3.0"
    if (!parse_number(word, number) || !(std::abs(number) <= 9e15) || number != std::floor(number))
      return refuse(word);
    result = static_cast<std::int64_t>(number);
    return true;
  }

  bool skip(PlyType, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      if (next_word().empty()) return false;
    }
    return true;
  }

  bool holds(PlyType, std::uint64_t count) const { return count <= (rest() + 1) / 2; }

  // Call this function after reading all values of an element with properties.
  void end_element() {
    if (!lines_hold_elements_) return;
    bool surplus = false;
    for (; at_ < text_.size() && !is_line_end(text_[at_]); ++at_) surplus |= !is_blank(text_[at_]);
    surplus_elements_ += surplus;
  }
  // Returns the number of elements with more words than the header declares.
  std::uint64_t surplus_elements() const { return surplus_elements_; }

  std::size_t offset() const { return at_; }
  std::uint64_t rest() const { return text_.size() - at_; }
  std::uint64_t bytes_left_over() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    return rest();
  }
  PlyFault fault() const { return fault_; }
  std::string place() const {
    std::uint64_t line = 1;
    for (std::size_t i = 0; i < at_; ++i)
      line += text_[i] == '\n' || (text_[i] == '\r' && text_.substr(i + 1, 1) != "\n");
    return "line " + std::to_string(line);
  }

 private:
  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }

  // Counts the remaining lines that are not blank, up to `most`.
  std::uint64_t count_lines(std::uint64_t most) const {
    std::uint64_t count = 0;
    bool blank = true;
    for (std::size_t i = at_; i < text_.size() && count < most; ++i) {
      if (!is_line_end(text_[i])) {
        blank = blank && is_blank(text_[i]);
      } else if (!blank) {
        ++count;
        blank = true;
      }
    }
    return count + (blank || count == most ? 0 : 1);
  }

  std::string_view next_word() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    std::size_t end = at_;
    while (end < text_.size() && !is_blank(text_[end])) ++end;
    const std::string_view word = text_.substr(at_, end - at_);
    at_ = end;
    if (word.empty()) fault_ = PlyFault::end_of_file;
    return word;
  }
  bool refuse(std::string_view word) {
    at_ -= word.size();
    fault_ = PlyFault::not_a_number;
    return false;
  }

  std::string_view text_;
  std::size_t at_;
  bool lines_hold_elements_;
  std::uint64_t surplus_elements_ = 0;
  PlyFault fault_ = PlyFault::none;
};

}  // namespace strata::mesh
