#include "support/test_cluster.h"

#include <gtest/gtest.h>
#include <libpq-fe.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <atomic>
#include <stdexcept>

namespace strata::test {
namespace {

struct Shared {
  TemporaryFolder folder;
  std::unique_ptr<store::Cluster> cluster;
};
std::unique_ptr<Shared> shared;

class StopAtEnd : public ::testing::Environment {
 public:
  void TearDown() override { shared.reset(); }
};
const auto* const kStopAtEnd = ::testing::AddGlobalTestEnvironment(new StopAtEnd);

}  // namespace

TemporaryFolder::TemporaryFolder() {
  char name[] = "/tmp/strata-test-XXXXXX";
  if (!mkdtemp(name)) throw std::runtime_error("mkdtemp failed");
  chmod(name, 0755);
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

store::Cluster& shared_cluster() {
  if (!shared) {
    auto fresh = std::make_unique<Shared>();
    auto cluster = store::Cluster::start(fresh->folder.path());
    if (!cluster) throw std::runtime_error("no PostgreSQL for the tests: " + cluster.error().detail);
    fresh->cluster = std::move(*cluster);
    shared = std::move(fresh);
  }
  if (auto running = shared->cluster->ensure_running(); !running) throw std::runtime_error(running.error().detail);
  return *shared->cluster;
}

std::string fresh_database() {
  static std::atomic<int> count{0};
  const std::string name = "test_" + std::to_string(++count);
  const std::unique_ptr<PGconn, decltype(&PQfinish)> connection(PQconnectdb(shared_cluster().dsn("postgres").c_str()),
                                                                &PQfinish);
  const std::unique_ptr<PGresult, decltype(&PQclear)> made(PQexec(connection.get(), ("CREATE DATABASE " + name).c_str()),
                                                           &PQclear);
  if (PQresultStatus(made.get()) != PGRES_COMMAND_OK) throw std::runtime_error(PQerrorMessage(connection.get()));
  return shared_cluster().dsn(name);
}

std::unique_ptr<store::Store> open_store(const std::string& dsn, int connections) {
  auto opened = store::Store::open({dsn, connections}, STRATA_MIGRATIONS_DIR);
  if (!opened) throw std::runtime_error("store not opened: " + opened.error().detail);
  return std::move(*opened);
}

std::unique_ptr<store::Store> fresh_store(int connections) { return open_store(fresh_database(), connections); }

}  // namespace strata::test
