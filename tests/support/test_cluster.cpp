#include "support/test_cluster.h"
#include "strata_dirs.h"

#include <gtest/gtest.h>
#include <libpq-fe.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace strata::test {
namespace {

struct Shared {
  TemporaryFolder folder;
  std::unique_ptr<store::Cluster> cluster;
  bool migrated = false;
};
std::unique_ptr<Shared> shared;

class StopAtEnd : public ::testing::Environment {
 public:
  void TearDown() override { shared.reset(); }
};
const auto* const kStopAtEnd = ::testing::AddGlobalTestEnvironment(new StopAtEnd);

}  // namespace

TemporaryFolder::TemporaryFolder() {
  // Use main memory if it has enough space, because every initdb is slow on a disk. The tests kill
  // processes, not machines, so the data need not survive a power failure.
  std::error_code error;
  const char* parent = std::getenv("STRATA_TEST_TMP");
  const auto space = std::filesystem::space("/dev/shm", error);
  const bool in_memory =
      !error && space.available > (std::uintmax_t{3} << 30) && access("/dev/shm", W_OK) == 0;
  std::string name = std::string(parent      ? parent
                                 : in_memory ? "/dev/shm"
                                             : "/tmp") +
                     "/strata-test-XXXXXX";
  if (!mkdtemp(name.data())) throw std::runtime_error("mkdtemp failed: " + name);
  chmod(name.c_str(), 0755);
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

namespace {

// Keeps owners and modes, which PostgreSQL requires and std::filesystem::copy does not keep.
void copy_folder(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::string program = "cp", archive = "-a", source = from / ".", target = to;
  std::array<char*, 5> words{program.data(), archive.data(), source.data(), target.data(), nullptr};
  pid_t copier = 0;
  int status = -1;
  if (posix_spawnp(&copier, "cp", nullptr, nullptr, words.data(), environ) != 0 ||
      waitpid(copier, &status, 0) != copier || status != 0)
    throw std::runtime_error("not copied: " + from.string());
}

}  // namespace

store::Cluster& shared_cluster() {
  if (!shared) {
    auto fresh = std::make_unique<Shared>();
    if (const char* prepared = std::getenv("STRATA_TEST_PREPARED"))
      copy_folder(std::filesystem::path(prepared) / "empty", fresh->folder.path());
    auto cluster = store::Cluster::start(fresh->folder.path());
    if (!cluster)
      throw std::runtime_error("no PostgreSQL for the tests: " + cluster.error().detail);
    fresh->cluster = std::move(*cluster);
    shared = std::move(fresh);
  }
  if (auto running = shared->cluster->ensure_running(); !running)
    throw std::runtime_error(running.error().detail);
  return *shared->cluster;
}

void kill_postmaster(const store::Cluster& cluster) {
  const int pid = cluster.postmaster_pid();
  kill(pid, SIGKILL);
  for (char state = 'R'; state != 'Z' && state != 'X';) {
    std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
    std::string ignored;
    if (!(stat >> ignored >> ignored >> state)) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

namespace {

std::vector<int> children_of(int parent) {
  std::vector<int> children;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream status(entry.path() / "status");
    for (std::string line; std::getline(status, line);)
      if (line.starts_with("PPid:") && std::stoi(line.substr(5)) == parent)
        children.push_back(std::stoi(name));
  }
  return children;
}

}  // namespace

Hang::Hang(const store::Cluster& cluster) : cluster_(cluster), stopped_{cluster.postmaster_pid()} {
  ::kill(stopped_.front(), SIGSTOP);  // stopped first, so it starts no new processes
  for (const int child : children_of(stopped_.front())) {
    ::kill(child, SIGSTOP);
    stopped_.push_back(child);
  }
}

Hang::~Hang() {
  for (const int pid : stopped_) ::kill(pid, SIGCONT);
}

void Hang::kill() {
  kill_postmaster(cluster_);
  for (const int pid : stopped_) ::kill(pid, SIGKILL);
  stopped_.clear();
}

namespace {

std::string create_database(const std::string& of_template) {
  static std::atomic<int> count{0};
  const std::string name = "test_" + std::to_string(++count);
  const std::unique_ptr<PGconn, decltype(&PQfinish)> connection(
      PQconnectdb(shared_cluster().dsn("postgres").c_str()), &PQfinish);
  const std::unique_ptr<PGresult, decltype(&PQclear)> made(
      PQexec(connection.get(), ("CREATE DATABASE " + name + " TEMPLATE " + of_template).c_str()),
      &PQclear);
  if (PQresultStatus(made.get()) != PGRES_COMMAND_OK)
    throw std::runtime_error(PQerrorMessage(connection.get()));
  return shared_cluster().dsn(name);
}

}  // namespace

std::string empty_database() { return create_database("template1"); }

std::string fresh_database() {
  // No test uses the cluster's own database, so it serves as the template once it is migrated.
  const store::Cluster& cluster = shared_cluster();
  if (!shared->migrated) open_store(cluster.dsn(), 1);
  shared->migrated = true;
  return create_database("strata");
}

std::unique_ptr<store::Store> open_store(const std::string& dsn, int connections) {
  auto opened = store::Store::open({dsn, connections}, STRATA_MIGRATIONS_DIR);
  if (!opened) throw std::runtime_error("store not opened: " + opened.error().detail);
  return std::move(*opened);
}

std::unique_ptr<store::Store> fresh_store(int connections) {
  return open_store(fresh_database(), connections);
}

}  // namespace strata::test
