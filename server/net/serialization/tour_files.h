#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/ids.h"
#include "protocol/messages.h"
#include "store/content/tour_files.h"

namespace strata::net {

using TourFilesById = std::map<store::TourFileId, store::TourFile>;

// Returns how a tour uses a file of this type. Returns nothing if no browser plays such a file.
std::optional<protocol::TourFileKind> tour_file_kind(std::string_view media_type);
nlohmann::json to_json(const store::TourFile& file);

// Refuses (invalid) media that are not files of the tour, and files of an unsuitable kind.
Result<void> check_media(const std::vector<protocol::TourMedium>& media, const TourFilesById& files,
                         const std::string& field);
// Checks the logo in the same way.
Result<void> check_logo(const protocol::TourTheme& theme, const TourFilesById& files);

// Returns the files in the stored content of a tour.
std::set<store::TourFileId> files_in(const nlohmann::json& content);

}  // namespace strata::net
