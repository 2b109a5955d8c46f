#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "mesh/io/load.h"

namespace strata::test {

// Writes PLY files value by value, in any encoding, for tests of the reader.
class PlyWriter {
 public:
  enum class Encoding { ascii, little, big };

  PlyWriter(Encoding encoding, const std::string& declarations) : encoding_(encoding) {
    const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    bytes_ = "ply\nformat " + std::string(names[static_cast<int>(encoding)]) + " 1.0\n" +
             declarations + "end_header\n";
  }

  template <class Number>
  PlyWriter& put(Number value) {
    if (encoding_ == Encoding::ascii) {
      std::ostringstream text;
      text.precision(17);
      text << +value << ' ';
      bytes_ += text.str();
      return *this;
    }
    char raw[sizeof(Number)];
    std::memcpy(raw, &value, sizeof raw);
    if (encoding_ == Encoding::big) {
      for (std::size_t i = 0; i < sizeof raw / 2; ++i) std::swap(raw[i], raw[sizeof raw - 1 - i]);
    }
    bytes_.append(raw, sizeof raw);
    return *this;
  }
  template <class Number>
  PlyWriter& put_all(std::initializer_list<Number> values) {
    for (Number value : values) put(value);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  Encoding encoding_;
  std::string bytes_;
};

inline Result<mesh::LoadedMesh> load_text(const std::string& bytes, const std::string& filename) {
  Progress progress;
  return mesh::load_mesh_bytes({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()},
                               filename, progress);
}

// Makes files by name, in memory. `texts` must outlive the result.
inline Result<mesh::InputFiles> files_of(
    const std::vector<std::pair<std::string, std::string>>& texts, bool parts = false) {
  std::vector<mesh::InputFiles::Entry> entries;
  for (const auto& [name, text] : texts)
    entries.push_back(
        {name, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, std::nullopt});
  Progress progress;
  return mesh::InputFiles::of(std::move(entries), std::filesystem::temp_directory_path(), progress,
                              parts);
}

inline Result<mesh::LoadedMesh> load_texts(
    const std::vector<std::pair<std::string, std::string>>& texts,
    const mesh::LoadOptions& options = {}) {
  auto files = files_of(texts, options.parts);
  if (!files) return tl::unexpected(files.error());
  Progress progress;
  return mesh::load_mesh(std::move(*files), progress, options);
}

inline std::uint64_t count_of(const std::vector<Repair>& repairs, const std::string& what) {
  for (const Repair& repair : repairs) {
    if (repair.what == what) return repair.count;
  }
  return 0;
}

}  // namespace strata::test
