#include "app/deposit/bag.h"

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <chrono>
#include <exception>
#include <fstream>
#include <memory>

#include "core/digest.h"
#include "core/mapped_file.h"
#include "core/text/bytes.h"
#include "core/text/filename.h"
#include "core/text/hex.h"
#include "core/text/timestamp.h"
#include "core/zip_file.h"

namespace strata::app {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kPiece = 1u << 20;
constexpr const char* kDeclaration = "BagIt-Version: 1.0\nTag-File-Character-Encoding: UTF-8\n";

// An error inside the writing of a zip, which has no results.
struct ContentFault : std::exception {
  explicit ContentFault(Error the_problem) : problem(std::move(the_problem)) {}
  const char* what() const noexcept override { return "content not readable"; }
  Error problem;
};

tl::unexpected<Error> unwritable() {
  return fail(ErrorCode::storage_full, "File not written",
              "The disk of the server is full or not writable, so the file was not made. Free disk "
              "space.");
}

bool is_compressed(const BagFile& file) {
  for (const char* type : {"image/jpeg", "image/png", "image/webp", "image/tiff", "video/",
                           "audio/mp", "application/zip", "application/pdf"})
    if (file.media_type.starts_with(type)) return true;
  return false;
}

// RFC 8493, section 2.1.3: only these characters are encoded.
std::string manifest_path(const std::string& path) {
  std::string encoded;
  for (const char c : path) {
    if (c == '%')
      encoded += "%25";
    else if (c == '\n')
      encoded += "%0A";
    else if (c == '\r')
      encoded += "%0D";
    else
      encoded += c;
  }
  return encoded;
}

std::string size_for_people(std::uint64_t bytes) {
  constexpr const char* kUnits[] = {"B", "KB", "MB", "GB", "TB", "PB"};
  std::size_t unit = 0;
  while (bytes >= 10'000 && unit + 1 < std::size(kUnits)) {
    bytes /= 1000;
    ++unit;
  }
  return std::to_string(bytes) + " " + kUnits[unit];
}

// The values of bag-info.txt have no line ends.
std::string info_line(const std::string& label, std::string value) {
  std::ranges::replace_if(
      value, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return label + ": " + value + "\n";
}

}  // namespace

std::string portable_name(const std::string& name, const std::string& fallback) {
  std::string safe = base_filename(name);
  for (char& c : safe)
    if (std::string_view("<>:\"/\\|?*").find(c) != std::string_view::npos) c = '_';
  while (!safe.empty() && (safe.back() == '.' || safe.back() == ' ')) safe.pop_back();
  return safe.empty() || safe.front() == '.' ? fallback + safe : safe;
}

std::string Bag::free_path(const std::string& path) const {
  const auto is_taken = [&](const std::string& candidate) {
    return taken_.contains(boost::algorithm::to_lower_copy(candidate));
  };
  if (!is_taken(path)) return path;
  const auto folder = path.rfind('/');
  const auto dot = path.rfind('.');
  const std::size_t stem =
      dot == std::string::npos || (folder != std::string::npos && dot < folder) ? path.size() : dot;
  for (int i = 2;; ++i) {
    std::string candidate = path.substr(0, stem) + "-" + std::to_string(i) + path.substr(stem);
    if (!is_taken(candidate)) return candidate;
  }
}

fs::path Bag::next_file() const { return folder_ / std::to_string(files_.size()); }

void Bag::keep(BagFile file, std::optional<fs::path> made) {
  taken_.insert(boost::algorithm::to_lower_copy(file.path));
  files_.push_back(std::move(file));
  made_.push_back(std::move(made));
}

Result<void> Bag::add_made(BagFile file) {
  const fs::path place = next_file();
  const auto mapped = STRATA_TRY(MappedFile::open(place));
  Sha256Stream hash;
  const std::string_view all = mapped.view();
  for (std::size_t at = 0; at < all.size(); at += kPiece) {
    const std::string_view piece = all.substr(at, kPiece);
    hash.add(bytes_of(piece));
    mapped.release(piece);
  }
  file.sha256 = to_hex(hash.finish());
  file.bytes = all.size();
  keep(std::move(file), place);
  return {};
}

Result<void> Bag::add(BagFile file, std::span<const std::uint8_t> bytes) {
  const fs::path place = next_file();
  std::ofstream out(place, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) return unwritable();
  file.sha256 = to_hex(sha256(bytes));
  file.bytes = bytes.size();
  keep(std::move(file), place);
  return {};
}

Result<void> Bag::add(BagFile file, std::string_view text) {
  return add(std::move(file), bytes_of(text));
}

void Bag::add_stored(BagFile file) { keep(std::move(file), std::nullopt); }

std::uint64_t Bag::bytes() const {
  std::uint64_t sum = 0;
  for (const BagFile& file : files_) sum += file.bytes;
  return sum;
}

Result<std::uint64_t> Bag::write(const std::string& name,
                                 const std::vector<std::pair<std::string, std::string>>& info,
                                 const fs::path& zip, Progress& progress) const {
  std::string manifest, about;
  for (const BagFile& file : files_)
    manifest += file.sha256 + "  data/" + manifest_path(file.path) + "\n";
  for (const auto& [label, value] : info)
    if (!value.empty()) about += info_line(label, value);
  const auto today = utc_text(std::chrono::system_clock::now()).substr(0, 10);
  about += info_line("Bagging-Date", today);
  about += info_line("Bag-Size", size_for_people(bytes()));
  about += info_line("Payload-Oxum", std::to_string(bytes()) + "." + std::to_string(files_.size()));
  std::string tag_manifest;
  const std::pair<const char*, std::string_view> tags[] = {
      {"bag-info.txt", about}, {"bagit.txt", kDeclaration}, {"manifest-sha256.txt", manifest}};
  for (const auto& [tag, text] : tags) tag_manifest += sha256_hex(text) + "  " + tag + "\n";

  std::vector<ZipEntry> entries;
  const std::string folder = name + "/";
  for (const auto& [tag, text] : tags) entries.push_back({folder + tag, bytes_of(text)});
  entries.push_back({folder + "tagmanifest-sha256.txt", bytes_of(tag_manifest)});
  const double total = static_cast<double>(std::max<std::uint64_t>(bytes(), 1));
  std::uint64_t written = 0;
  const auto report = [&](std::uint64_t count) {
    written += count;
    progress.report(static_cast<double>(written) / total, "Writing the files");
  };
  for (std::size_t i = 0; i < files_.size(); ++i) {
    const BagFile& file = files_[i];
    std::function<NextPiece()> begin;
    if (made_[i]) {
      begin = [&report, &place = *made_[i]]() -> NextPiece {
        auto in = std::make_shared<std::ifstream>(place, std::ios::binary);
        return [&report, in](std::string& text) {
          text.resize(kPiece);
          in->read(text.data(), static_cast<std::streamsize>(kPiece));
          text.resize(static_cast<std::size_t>(in->gcount()));
          report(text.size());
          return !text.empty();
        };
      };
    } else {
      begin = [this, &report, &file]() -> NextPiece {
        return [this, &report, &file, at = std::uint64_t{0}](std::string& text) mutable {
          if (at >= file.bytes) return false;
          const std::uint64_t end = std::min(at + kPiece, file.bytes);
          auto read = read_stored_(file.sha256, at, end, [&](std::span<const std::uint8_t> bytes) {
            text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
            return true;
          });
          if (!read) throw ContentFault(read.error());
          at = end;
          report(text.size());
          return true;
        };
      };
    }
    entries.push_back({folder + "data/" + file.path, std::move(begin), !is_compressed(file)});
  }
  try {
    STRATA_TRY(write_zip(entries, zip, progress));
  } catch (const ContentFault& fault) {
    return tl::unexpected(fault.problem);
  }
  std::error_code error;
  const std::uint64_t size = fs::file_size(zip, error);
  return error ? Result<std::uint64_t>(unwritable()) : size;
}

}  // namespace strata::app
