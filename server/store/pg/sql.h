#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

// SQL statements that are assembled at compile time, from pieces that several statements share.
namespace strata::store {

template <std::size_t Length>
struct SqlText {
  std::array<char, Length + 1> text{};

  const char* c_str() const& { return text.data(); }
  const char* c_str() const&& = delete;  // the text would be destroyed before it is read
};

template <class Piece>
constexpr std::size_t kSqlLength = 0;
template <std::size_t Size>
constexpr std::size_t kSqlLength<char[Size]> = Size - 1;
template <std::size_t Length>
constexpr std::size_t kSqlLength<SqlText<Length>> = Length;

template <std::size_t Size>
consteval const char* sql_begin(const char (&literal)[Size]) {
  return literal;
}
template <std::size_t Length>
consteval const char* sql_begin(const SqlText<Length>& piece) {
  return piece.text.data();
}

// Joins literals and results of this function: sql("SELECT ", kColumns, " FROM layers").
template <class... Pieces>
consteval auto sql(const Pieces&... pieces) {
  SqlText<(kSqlLength<Pieces> + ...)> joined;
  auto at = joined.text.begin();
  ((at = std::copy_n(sql_begin(pieces), kSqlLength<Pieces>, at)), ...);
  return joined;
}

}  // namespace strata::store
