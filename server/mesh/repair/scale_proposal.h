#pragma once

#include "domain/scene/model.h"
#include "mesh/io/load.h"

namespace strata::mesh {

// Proposes the unit and the up direction of a file, from the file's data or its shape, with the
// reason:
//
// - the format: glTF is in meters with +Y up
// - a comment of the file, see stated_unit and stated_up
// - map coordinates (`crs`, or far from 0 for their extent): meters, +Z up
// - the size: the unit that makes it as large as usual scanned objects (kSizes of
//   scale_proposal.cpp)
// - the shape: how it would stand, see up_shares
//
// Reads each vertex a few times. Any thread.
ScaleProposal propose_scale(const LoadedMesh& loaded, const std::string& crs);

}  // namespace strata::mesh
