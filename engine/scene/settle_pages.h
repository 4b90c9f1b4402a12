// What of a frame's cuts can be drawn, of models whose surfels are paged.
#pragma once

#include "engine/scene/draw_list.h"
#include "engine/scene/paging.h"

namespace splice {

/// Asks for the surfels that the cuts are made of, with `wait` until they are there, and puts leaves of the point tree
/// in place of those that are not. So every surfel that may be seen is still in the cut once. With `wait` the result
/// depends on the cuts alone: where more is needed than the limit allows, it is the blocks with most surfels in the
/// cuts, the first of equals, that are drawn. Throws what reading throws.
PageStats settle_pages(DrawList& draws, bool wait);

}  // namespace splice
