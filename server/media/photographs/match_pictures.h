#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace strata::photo {

// Returns the index of the picture of each photograph, or nothing if it has none. `photographs` are
// their names in the export (PosedPhotograph::name), and `pictures` are the users' names of image
// files, with or without folders.
//
// The last parts of the names must be equal, without regard to upper and lower case. If no picture
// has the name of the photograph, names without their extensions are compared: Metashape leaves
// them out, and pictures are often converted after the alignment. Of several pictures, the one with
// the longest common end of folders is used. A photograph has no picture if several are equally
// close. A picture of several photographs belongs to the closest one, and to none if several are
// equally close. Takes little more time than sorting the names.
std::vector<std::optional<std::size_t>> match_pictures(std::span<const std::string> photographs,
                                                       std::span<const std::string> pictures);

}  // namespace strata::photo
