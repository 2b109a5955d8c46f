#pragma once

#include "core/digest.h"
#include "domain/scene/look.h"
#include "store/pg/pg.h"

namespace strata::store {

Result<void> check_look(const Look& look);
// One row, its slug made from the wish or the name; `picture` is a blob that the transaction at
// hand keeps.
Result<Look> insert_look(PgConnection& connection, const Look& look, const Sha256& picture);

}  // namespace strata::store
