#include "store/cluster/archive_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>

#include "core/text/timestamp.h"
#include "core/uuid.h"

namespace strata::store {
namespace fs = std::filesystem;
namespace {

constexpr int kArchiveFormat = 1;
constexpr const char* kIdFile = "archive.json";  // in the archive and in the folder of the cluster
constexpr const char* kNewIdFile = "archive.json.new";
// The time after which PostgreSQL archives a segment that is not full. If the disk fails, only the
// changes of this time can be lost.
constexpr const char* kArchiveTimeout = "archive_timeout=60s";

fs::path absolute_folder(const fs::path& folder) {
  std::error_code error;
  return (fs::weakly_canonical(fs::absolute(folder, error), error) / "").parent_path();
}

bool is_within(const fs::path& inner, const fs::path& outer) {
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

std::optional<nlohmann::json> read_id_file(const fs::path& folder) {
  std::ifstream in(folder / kIdFile);
  if (!in) return std::nullopt;
  auto content = nlohmann::json::parse(in, nullptr, false);
  return content.is_object() && content.contains("id") && content["id"].is_string()
             ? std::optional(std::move(content))
             : std::nullopt;
}

Result<void> write_id_file(const fs::path& folder, const nlohmann::json& content) {
  const fs::path file = folder / kNewIdFile;
  const std::string text = content.dump() + "\n";
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const bool written = fd >= 0 &&
                       write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                       fsync(fd) == 0;
  if (fd >= 0) close(fd);
  std::error_code error;
  if (written) fs::rename(file, folder / kIdFile, error);
  if (!written || error)
    return fail(ErrorCode::internal, "Archive not created",
                "Cannot write " + (folder / kIdFile).string() + ".", "--archive");
  sync_folder(folder);
  return {};
}

// An interrupted start may have left the first file of the archive.
bool is_unused(const fs::path& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().filename() != kNewIdFile) return false;
  return true;
}

// Quotes a path for the shell, in a command in which PostgreSQL replaces %p and %f.
std::string in_command(const fs::path& path) {
  std::string out = "'";
  for (const char c : path.string()) {
    if (c == '\'')
      out += "'\\''";
    else if (c == '%')
      out += "%%";
    else
      out += c;
  }
  return out + "'";
}

std::optional<ArchiveFolder::Copy> read_copy(const fs::path& folder) {
  std::string moment = folder.filename().string();
  if (moment.size() < 17) return std::nullopt;
  moment[13] = moment[16] = ':';
  const auto made = parse_time(moment);
  std::ifstream in(folder / "backup_label");
  std::ostringstream label;
  label << in.rdbuf();
  const auto first = first_segment_of(label.str());
  if (!made || !first || copy_name(*made) != folder.filename()) return std::nullopt;
  return ArchiveFolder::Copy{folder, *made, *first};
}

}  // namespace

Result<ArchiveFolder> ArchiveFolder::claim(const fs::path& place, const fs::path& cluster,
                                           const DatabaseUser& user) {
  const fs::path folder = absolute_folder(place), data = absolute_folder(cluster.parent_path());
  if (is_within(folder, data) || is_within(data, folder))
    return fail(ErrorCode::invalid, "Archive in the data folder",
                "The archive " + folder.string() + " and the data folder " + data.string() +
                    " must not contain each other. Choose a folder on another disk.",
                "--archive");
  std::error_code error;
  auto own = read_id_file(cluster);
  if (!own) {
    own = nlohmann::json{{"id", to_string(random_uuid())}};
    STRATA_TRY(write_id_file(cluster, *own));
  }
  if (!fs::exists(folder / kIdFile, error)) {
    if (own->value("folder", "") == folder.string())
      return fail(ErrorCode::conflict, "Archive missing",
                  "The archive is no longer in " + folder.string() +
                      ". Mount its disk. To begin a new archive, choose another folder.",
                  "--archive");
    if (!is_unused(folder))
      return fail(ErrorCode::conflict, "Not an archive",
                  folder.string() + " contains other files. Choose a new or an empty folder.",
                  "--archive");
    STRATA_TRY(give_folder(folder, user));
    STRATA_TRY(write_id_file(folder, {{"format", kArchiveFormat}, {"id", (*own)["id"]}}));
  }
  auto archive = STRATA_TRY(open(folder));
  if (archive.id_ != (*own)["id"].get<std::string>())
    return fail(ErrorCode::conflict, "Archive of another site",
                folder.string() +
                    " is the archive of another data folder. A restored site needs a new archive, "
                    "too. Choose a new folder, and keep this archive as long as you need it.",
                "--archive");
  if (own->value("folder", "") != folder.string()) {
    (*own)["folder"] = folder.string();
    STRATA_TRY(write_id_file(cluster, *own));
  }
  for (const fs::path& each : {folder, archive.wal(), archive.copies_folder()})
    STRATA_TRY(give_folder(each, user));
  return archive;
}

Result<ArchiveFolder> ArchiveFolder::open(const fs::path& place) {
  const fs::path folder = absolute_folder(place);
  const auto content = read_id_file(folder);
  if (!content)
    return fail(ErrorCode::not_found, "Archive not found",
                "Cannot read " + (folder / kIdFile).string() +
                    ". Specify the folder of `strata serve --archive`, and run the command as the "
                    "user of the server.",
                "--archive");
  if (content->value("format", 0) != kArchiveFormat)
    return fail(ErrorCode::invalid, "Newer archive format",
                folder.string() + " was written by a newer version of Strata. Use that version.",
                "--archive");
  return ArchiveFolder(folder, (*content)["id"].get<std::string>());
}

std::vector<ArchiveFolder::Copy> ArchiveFolder::copies() const {
  std::vector<Copy> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(copies_folder(), error))
    if (auto copy = read_copy(entry.path())) found.push_back(std::move(*copy));
  std::sort(found.begin(), found.end(),
            // not by time alone, because a clock may have been wrong
            [](const Copy& a, const Copy& b) {
              return std::tie(a.first, a.made) < std::tie(b.first, b.made);
            });
  return found;
}

std::set<WalSegment> ArchiveFolder::segments() const {
  std::set<WalSegment> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(wal(), error)) {
    const fs::path name = entry.path().filename();
    if (name.extension() != ".gz") continue;
    if (const auto segment = parse_wal_name(name.stem().string())) found.insert(*segment);
  }
  return found;
}

std::vector<std::string> ArchiveFolder::archive_settings() const {
  // A segment that was archived but not yet marked as archived is archived again, so an existing
  // file with the same content is a success. A segment that is not full compresses to a few KB.
  const std::string folder = in_command(wal());
  return {"archive_mode=on", kArchiveTimeout,
          "archive_command=f=" + folder +
              "/%f.gz; if test -e \"$f\"; then gzip -dc \"$f\" | cmp -s - \"%p\" || { echo "
              "\"strata: $f already exists with other content\" >&2; false; }; else gzip -1 < "
              "\"%p\" > \"$f.part\" && sync \"$f.part\" && mv \"$f.part\" \"$f\" && sync " +
              folder + "; fi"};
}

std::vector<std::string> ArchiveFolder::recovery_settings(
    const std::optional<std::chrono::system_clock::time_point>& moment) const {
  // PostgreSQL takes a failed command as the end of the WAL, and only a status above 125 as an
  // error. A damaged segment must not look like the end.
  const std::string file = in_command(wal()) + "/%f.gz";
  std::vector<std::string> settings{
      "archive_mode=off",
      // so that clients can connect only after the recovery
      "hot_standby=off",
      "restore_command=test -d " + in_command(wal()) + " || exit 200; test -e " + file +
          " || exit 1; gzip -dc " + file + " > \"%p\" || exit 200",
      // the archive contains no other history of the site
      "recovery_target_timeline=current", "recovery_target_action=promote"};
  if (moment) {
    std::string time = utc_text(*moment);
    // PostgreSQL reads its settings before the names of time zones, such as Z.
    time.replace(time.size() - 1, 1, "+00");
    settings.push_back("recovery_target_time=" + time);
  }
  return settings;
}

std::string copy_name(std::chrono::system_clock::time_point made) {
  std::string name = utc_text(made);
  name[13] = name[16] = '-';  // other systems do not allow a colon in a file name
  return name;
}

void sync_folder(const fs::path& folder) {
  const int fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  fsync(fd);
  close(fd);
}

}  // namespace strata::store
