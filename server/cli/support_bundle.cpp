#include "cli/support_bundle.h"

#include <sys/stat.h>
#include <zip.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <optional>
#include <utility>

#include "cli/install_dirs.h"
#include "cli/support_machine.h"
#include "cli/support_secrets.h"
#include "core/text/ascii.h"
#include "core/version.h"
#include "store/cluster/support_facts.h"

namespace strata::cli {
namespace {

struct BundleFile {
  std::string name, about, content;
};

class Bundle {
 public:
  void add(std::string name, std::string about, std::string content) {
    files_.push_back({std::move(name), std::move(about), std::move(content)});
  }
  void add(std::string name, std::string about, const nlohmann::json& content) {
    add(std::move(name), std::move(about),
        content.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  }
  void leave_out(const std::string& what, const std::string& why) {
    left_out_ += "- " + what + ": " + why + "\n";
  }
  void add_manifest() {
    std::string text = "Support bundle of Strata " + std::string(version()) + "\n\n";
    for (const BundleFile& file : files_) text += file.name + "\n    " + file.about + "\n";
    if (!left_out_.empty()) text += "\nNot in this bundle:\n" + left_out_;
    text +=
        "\nThe bundle contains no passwords, tokens or links, and no content of models and tables."
        "\nNames of people are replaced by pseudonyms. Read it before you send it.\n";
    add("MANIFEST.txt", "this list", text);
  }
  const std::vector<BundleFile>& files() const { return files_; }

 private:
  std::vector<BundleFile> files_;
  std::string left_out_;
};

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

int port_of(const std::string& listen) {
  const auto colon = listen.rfind(':');
  return colon == std::string::npos ? 0 : std::atoi(listen.c_str() + colon + 1);
}

KnownSecrets secrets_of(const DataOptions& data, const store::SupportFacts* facts) {
  KnownSecrets secrets;
  secrets.add("the owner's token", environment("STRATA_OWNER_TOKEN"));
  secrets.add("the password of the database", environment("PGPASSWORD"));
  secrets.add("the password of the database", environment("STRATA_DATABASE_PASSWORD"));
  for (const char* name : {"AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY", "AWS_SESSION_TOKEN"})
    secrets.add("a key of the bucket of the files", environment(name));
  for (auto& password : store::without_passwords(data.database).passwords)
    secrets.add("a password of --database", std::move(password));
  std::string sql_password;
  std::ifstream(data.data / "sql-password") >> sql_password;
  secrets.add("the password for SQL", std::move(sql_password));
  if (!facts) return secrets;
  for (const auto& secret : facts->secrets)
    secrets.add("the link for the phones of visitors, or the hash of a password", secret);
  secrets.hashes = facts->secret_hashes;
  return secrets;
}

void add_database(Bundle& bundle, const store::SupportFacts& facts) {
  bundle.add("database.json", "PostgreSQL: version, settings, connections and size", facts.server);
  bundle.add("migrations.json", "the migrations that were applied", facts.migrations);
  bundle.add("tables.json", "sizes of tables, dead rows, and when they were vacuumed",
             facts.tables);
  bundle.add("indexes.json", "sizes of indexes, and how often they were used", facts.indexes);
}

void add_logs(Bundle& bundle, const std::vector<std::filesystem::path>& files,
              const Pseudonyms& people) {
  int number = 0;
  for (const auto& file : files) {
    const auto lines = last_lines(file);
    const std::string name = file.filename().string();
    if (!lines) {
      bundle.leave_out("the log file " + people.replaced_in(name),
                       "it does not exist, or this user may not read it");
      continue;
    }
    bundle.add("logs/" + std::to_string(++number) + ".log",
               "the last lines of " + people.replaced_in(redacted(name)),
               people.replaced_in(redacted(*lines)));
  }
}

void add_server(Bundle& bundle, const std::string& listen) {
  const int port = port_of(listen);
  const auto metrics = port > 0 ? ask_local_server(port, "/metrics") : std::nullopt;
  if (!metrics)
    return bundle.leave_out("the metrics of the server",
                            "no server answers on this machine at port " + std::to_string(port) +
                                ". Enter its address with --listen.");
  bundle.add("metrics.txt", "the metrics of the running server", *metrics);
  if (const auto ready = ask_local_server(port, "/readyz"))
    bundle.add("readyz.json", "whether the running server is ready", *ready);
}

Result<void> check_no_secret(const Bundle& bundle, const KnownSecrets& secrets) {
  for (const BundleFile& file : bundle.files())
    if (const auto what = secrets.find_in(file.content))
      return fail(ErrorCode::conflict, "Secret in the support bundle",
                  "The file " + file.name + " of the bundle would contain " + *what +
                      ", so no bundle was written. Remove the secret from the source of this file, "
                      "or leave out its log file.",
                  "--support");
  return {};
}

tl::unexpected<Error> not_written(const std::filesystem::path& file, const std::string& why) {
  return fail(ErrorCode::invalid, "Support bundle cannot be written",
              file.string() + ": " + why + ".", "--support");
}

// Only the current user may read the file.
Result<void> write_zip(const Bundle& bundle, const std::filesystem::path& file) {
  const mode_t before = umask(077);
  const std::unique_ptr<const mode_t, void (*)(const mode_t*)> restore(
      &before, [](const mode_t* mode) { umask(*mode); });
  int error = 0;
  zip_t* zip = zip_open(file.c_str(), ZIP_CREATE | ZIP_EXCL, &error);
  if (!zip)
    return not_written(file, error == ZIP_ER_EXISTS
                                 ? "the file exists, choose another name"
                                 : "the folder does not exist or cannot be written");
  for (const BundleFile& entry : bundle.files()) {
    zip_source_t* source = zip_source_buffer(zip, entry.content.data(), entry.content.size(), 0);
    if (source && zip_file_add(zip, entry.name.c_str(), source, ZIP_FL_ENC_UTF_8) >= 0) continue;
    if (source) zip_source_free(source);
    const std::string why = zip_strerror(zip);
    zip_discard(zip);
    return not_written(file, why);
  }
  if (zip_close(zip) == 0) return {};
  const std::string why = zip_strerror(zip);
  zip_discard(zip);
  return not_written(file, why);
}

}  // namespace

Result<void> write_support_bundle(const DataOptions& data, const SupportOptions& options,
                                  const std::string& checks, const nlohmann::json& graphics) {
  std::string dsn = data.database;
  if (dsn.empty())
    if (const auto state = store::Cluster::inspect(data.data); state.running) dsn = state.dsn;
  std::optional<store::SupportFacts> facts;
  std::string why_no_facts = "the database is not running";
  if (!dsn.empty()) {
    auto found = store::support_facts(dsn, install_dirs().migrations);
    if (found)
      facts = std::move(*found);
    else
      why_no_facts = found.error().title;
  }

  const Pseudonyms people(facts ? facts->people : std::vector<std::string>());
  Bundle bundle;
  bundle.add("version.json", "the version of this program", nlohmann::json{{"version", version()}});
  bundle.add("checks.txt", "the report of `strata doctor`", people.replaced_in(redacted(checks)));
  bundle.add("graphics.json", "the vendor, versions and limits of OpenGL", graphics);
  bundle.add("machine.json", "processor, memory, disks and limits", machine_facts(data.data));
  bundle.add("settings.json", "the settings, without secrets",
             people.replaced_in(settings_facts(data.data, data.database).dump(2) + "\n"));
  if (facts)
    add_database(bundle, *facts);
  else
    bundle.leave_out("the facts about the database", why_no_facts);
  if (facts) {
    std::vector<std::filesystem::path> logs = options.log_files;
    if (data.database.empty()) logs.push_back(data.data / "postgres" / "postgres.log");
    add_logs(bundle, logs, people);
  } else {
    bundle.leave_out("logs",
                     "without the database, the names of people are unknown and cannot be replaced "
                     "in the logs");
  }
  add_server(bundle, options.listen);
  bundle.add_manifest();
  STRATA_TRY(check_no_secret(bundle, secrets_of(data, facts ? &*facts : nullptr)));
  return write_zip(bundle, options.file);
}

}  // namespace strata::cli
