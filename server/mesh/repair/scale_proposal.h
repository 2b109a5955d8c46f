#pragma once

#include "domain/scene/model.h"
#include "mesh/io/load.h"

namespace strata::mesh {

// Which unit the numbers of a file are in and which way is up, as far as the file says it or its
// shape lets one guess, with the reason:
//
// - the format: glTF is in metres with +Y up
// - a comment of the file, see stated_unit and stated_up
// - coordinates of a map (`crs`, or far away from 0 for their extent): metres, +Z up
// - the size: which unit makes it as large as things that are scanned (kSizes of
// scale_proposal.cpp)
// - the shape: how it would stand, see up_shares
//
// Thread: any. Reads each vertex a few times.
ScaleProposal propose_scale(const LoadedMesh& loaded, const std::string& crs);

}  // namespace strata::mesh
