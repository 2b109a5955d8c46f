// strata-mesher: makes a triangle mesh from points. It is a program of its own, because the library
// for it cannot be interrupted and needs much memory: the server starts it with a limit, and kills
// it if the import is canceled (server/mesh/points/surface_from_points.h).
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <new>
#include <string>

#include "mesher/reconstruct.h"

namespace strata::mesher {
namespace {

using mesh::MesherExit;

struct Arguments {
  std::string points, surface;
  Settings settings;
  std::uint64_t memory_bytes = 0;
};

bool parse(const std::string& text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value >= 0 && value < 1e15;
}

// POINTS SURFACE CELL GAP MEMORY, where 0 is the default of CELL and GAP, and no limit of MEMORY.
bool parse(int count, char** words, Arguments& arguments) {
  if (count != 6) return false;
  double memory = 0;
  arguments.points = words[1];
  arguments.surface = words[2];
  const bool good = parse(words[3], arguments.settings.cell) &&
                    parse(words[4], arguments.settings.gap) && parse(words[5], memory);
  arguments.memory_bytes = static_cast<std::uint64_t>(memory);
  return good;
}

template <class T>
bool read_array(std::istream& in, std::vector<T>& values, std::uint64_t count) {
  values.resize(count);
  return bool(in.read(reinterpret_cast<char*>(values.data()),
                      static_cast<std::streamsize>(count * sizeof(T))));
}

template <class T>
void write_array(std::ostream& out, const std::vector<T>& values) {
  out.write(reinterpret_cast<const char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(T)));
}

bool read_points(const std::string& file, Points& points) {
  std::ifstream in(file, std::ios::binary);
  mesh::PointFileHeader header;
  if (!in.read(reinterpret_cast<char*>(&header), sizeof header) ||
      header.magic != mesh::PointFileHeader::kMagic)
    return false;
  return read_array(in, points.positions, header.points) &&
         (!header.has_normals || read_array(in, points.normals, header.points)) &&
         (!header.has_colors || read_array(in, points.colors, header.points));
}

bool write_surface(const std::string& file, const Surface& surface) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(&surface.facts), sizeof surface.facts);
  write_array(out, surface.positions);
  write_array(out, surface.colors);
  write_array(out, surface.triangles);
  return bool(out.flush());
}

void report(double fraction, const char* stage) {
  std::printf("%.3f %s\n", fraction, stage);
  std::fflush(stdout);
}

int run(int count, char** words) {
  Arguments arguments;
  if (!parse(count, words, arguments)) {
    std::cerr << "strata-mesher is started by strata. It has no use on its own.\n";
    return static_cast<int>(MesherExit::bad_arguments);
  }
  if (arguments.memory_bytes > 0) {
    const rlimit limit{arguments.memory_bytes, arguments.memory_bytes};
    setrlimit(RLIMIT_AS, &limit);
  }
  // People who work on models go first.
  [[maybe_unused]] const int kinder = nice(5);
  Points points;
  if (!read_points(arguments.points, points)) return static_cast<int>(MesherExit::bad_file);
  Surface surface;
  if (!reconstruct(points, arguments.settings, report, surface))
    return static_cast<int>(MesherExit::no_surface);
  if (!write_surface(arguments.surface, surface)) {
    std::cerr << "The surface could not be written: " << std::strerror(errno) << ".\n";
    return static_cast<int>(MesherExit::bad_file);
  }
  return 0;
}

}  // namespace
}  // namespace strata::mesher

int main(int count, char** words) {
  // OpenMP's threads wait for each other in loops by default. On a busy machine, they then take
  // forty times as long. The library reads the setting when it is loaded.
  if (!std::getenv("OMP_WAIT_POLICY")) {
    setenv("OMP_WAIT_POLICY", "passive", 1);
    execv("/proc/self/exe", words);
  }
  int status;
  try {
    status = strata::mesher::run(count, words);
  } catch (const std::bad_alloc&) {
    status = static_cast<int>(strata::mesh::MesherExit::out_of_memory);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    status = static_cast<int>(strata::mesh::MesherExit::no_surface);
  }
  std::fflush(nullptr);
  _exit(status);  // the system releases the memory faster than destructors
}
