#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace strata::bench {

using Command = std::function<int()>;
Command add_atlas(CLI::App& app);
Command add_distance(CLI::App& app);
Command add_edit(CLI::App& app);
Command add_frames(CLI::App& app);
Command add_import(CLI::App& app);
Command add_memory(CLI::App& app);
Command add_nearest(CLI::App& app);
Command add_operators(CLI::App& app);
Command add_query(CLI::App& app);
Command add_sheet(CLI::App& app);
Command add_stream(CLI::App& app);
Command add_viewer(CLI::App& app);

}  // namespace strata::bench
