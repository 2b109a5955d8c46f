#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace strata::cli {

// Returns the processor, the memory, the disks, the operating system and the limits of a container.
// The result contains no host name and no addresses.
nlohmann::json machine_facts(const std::filesystem::path& data);

// Returns the settings of this command and of the service, without secrets: the variables STRATA_…
// and the lines of /etc/default/strata.
nlohmann::json settings_facts(const std::filesystem::path& data, const std::string& database);

// Returns the body of a response of the server on this machine. Returns nothing if no server
// answers at the port, over HTTP or HTTPS.
std::optional<std::string> ask_local_server(int port, const std::string& path);

// Returns the last lines of a file, at most a megabyte. Returns nothing if it cannot be read.
std::optional<std::string> last_lines(const std::filesystem::path& file);

}  // namespace strata::cli
