/* bins_table.h - the bins of functional coverage. CYCLE(group, name, met): a cycle in which `met` is true fills the
 * bin; FRAME: a frame, once it is done, of one pipeline or several. `w` is the watch (bins_watch.h), `m` the machine,
 * `n` the frame's counters; of cycles, `now` and `was` are what blocks registered in it and before. bins.c includes it
 * for names and for predicates. */

/* ---- views: which way bricks come ---- */
#define OCTANTS(way, blend)                                                                                            \
    OCTANT(way "+x +y +z", 0, blend)                                                                                   \
    OCTANT(way "-x +y +z", 1, blend)                                                                                   \
    OCTANT(way "+x -y +z", 2, blend)                                                                                   \
    OCTANT(way "-x -y +z", 3, blend)                                                                                   \
    OCTANT(way "+x +y -z", 4, blend)                                                                                   \
    OCTANT(way "-x +y -z", 5, blend)                                                                                   \
    OCTANT(way "+x -y -z", 6, blend)                                                                                   \
    OCTANT(way "-x -y -z", 7, blend)
#define OCTANT(name, octant, under)                                                                                    \
    FRAME("octant", name, DIVIDED && (m->blend == VODR_BLEND_UNDER) == (under) && bins_octant(w, octant))
OCTANTS("back to front ", false)
OCTANTS("front to back ", true)
#define EYES(name, c)                                                                                                  \
    FRAME("eye", "before the volume along " name, DIVIDED &&bins_eye(w, c, -1))                                        \
    FRAME("eye", "within it along " name, DIVIDED &&bins_eye(w, c, 0))                                                 \
    FRAME("eye", "beyond it along " name, DIVIDED &&bins_eye(w, c, 1))
EYES("x", 0)
EYES("y", 1)
EYES("z", 2)
FRAME("eye", "within the volume", DIVIDED &&bins_eye(w, 0, 0) && bins_eye(w, 1, 0) && bins_eye(w, 2, 0))
#define AXES(name, order)                                                                                              \
    FRAME("dominant axis", name " x", m->traversal == (order) && bins_dominant(w, 0))                                  \
    FRAME("dominant axis", name " y", m->traversal == (order) && bins_dominant(w, 1))                                  \
    FRAME("dominant axis", name " z", m->traversal == (order) && bins_dominant(w, 2))
AXES("layer", VODR_TRAVERSAL_LAYER)
AXES("column", VODR_TRAVERSAL_COLUMN)
AXES("tile", VODR_TRAVERSAL_TILE)
FRAME("dominant axis", "two alike", DIVIDED &&bins_tie(w))

/* ---- what is drawn how ---- */
#define FILTERED(name, order, seen)                                                                                    \
    FRAME("traversal", name ", nearest", m->traversal == (order) && SEEN(seen) && m->filter == VODR_FILTER_NEAREST)    \
    FRAME("traversal", name ", linear", m->traversal == (order) && SEEN(seen) && m->filter == VODR_FILTER_LINEAR)
#define PROJECTED(name, order)                                                                                         \
    FILTERED(name ", parallel", order, false)                                                                          \
    FILTERED(name ", perspective", order, true)
PROJECTED("whole", VODR_TRAVERSAL_WHOLE)
PROJECTED("layer", VODR_TRAVERSAL_LAYER)
PROJECTED("column", VODR_TRAVERSAL_COLUMN)
PROJECTED("tile", VODR_TRAVERSAL_TILE)
#define BLENDED(name, mode)                                                                                            \
    FRAME("format", name ", 8 bits a channel", m->blend == (mode) && m->fb_bits == 8)                                  \
    FRAME("format", name ", 16 bits a channel", m->blend == (mode) && m->fb_bits == 16)                                \
    FRAME("format", name ", parallel", m->blend == (mode) && SEEN(false))                                              \
    FRAME("format", name ", perspective", m->blend == (mode) && SEEN(true))
BLENDED("over", VODR_BLEND_OVER)
BLENDED("under", VODR_BLEND_UNDER)
BLENDED("maximum", VODR_BLEND_MIP)
FRAME("format", "table narrower than the frame", m->tf_bits < m->fb_bits)
FRAME("format", "table wider than the frame", m->tf_bits > m->fb_bits)
FRAME("format", "densities of 8 bits", m->density_bits == 8)
FRAME("format", "densities of 12 bits", m->density_bits == 12)
FRAME("format", "weights of 1 bit", LINEAR && m->weight_bits == 1)
FRAME("format", "weights of 12 bits", LINEAR && m->weight_bits == 12)
FRAME("format", "no guard bits", LINEAR && m->guard_bits == 0)
FRAME("format", "6 guard bits", LINEAR && m->guard_bits == 6)
FRAME("format", "voxels of a byte as they are", w->c->input.voxel_bytes == 1 && !w->c->input.map)
FRAME("format", "voxels of a byte through a map", w->c->input.voxel_bytes == 1 && w->c->input.map)
FRAME("format", "voxels of two bytes", w->c->input.voxel_bytes == 2)
FRAME("format", "several pipelines", m->pipelines > 1)
FRAME("format", "a frame without a fragment", n->fragments == 0)

/* ---- volume divider ---- */
FRAME("volume divider", "one brick", DIVIDED && n->bricks == 1)
FRAME("volume divider", "a hundred bricks", n->bricks >= 100)
FRAME("volume divider", "bricks off the screen", DIVIDED && n->bricks > 0 && n->bricks + n->skipped_bricks < BRICKS)
FRAME("volume divider", "bricks left out as empty", n->skipped_bricks > 0)
FRAME("volume divider", "all bricks left out", n->skipped_bricks == BRICKS)
FRAME("volume divider", "none is empty", m->skip_empty && n->skipped_bricks == 0)
FRAME("volume divider", "a brick visited from several tiles", n->brick_visits > n->bricks)
FRAME("volume divider", "a brick larger than T", n->brick_overflows > 0)
FRAME("volume divider", "no brick larger than T", DIVIDED && n->brick_visits > 0 && n->brick_overflows == 0)
FRAME("volume divider", "the edge that is set", DIVIDED && m->brick > 0)
FRAME("volume divider", "the edge that fits", DIVIDED && m->brick == 0 && n->brick_vox > m->brick_min)
FRAME("volume divider", "the least edge", DIVIDED && m->brick == 0 && n->brick_vox == m->brick_min)
CYCLE("volume divider", "a cube", w->brick.moved &&SIDE(0) == SIDE(1) && SIDE(1) == SIDE(2))
CYCLE("volume divider", "a brick cut off", w->brick.moved && (SIDE(0) != SIDE(1) || SIDE(1) != SIDE(2)))
CYCLE("volume divider", "a visit of one slice",
      w->brick.moved && was->volume_divider.brick.k1 - was->volume_divider.brick.k0 == 1)
CYCLE("volume divider", "a visit of several",
      w->brick.moved && was->volume_divider.brick.k1 - was->volume_divider.brick.k0 > 1)

/* ---- links ---- */
#define LINK(name, link)                                                                                               \
    CYCLE("link", name " moves", w->link.moved)                                                                        \
    CYCLE("link", name " waits", w->link.waited)
LINK("brick", brick)
LINK("slice", slice)
LINK("fragment", fragment)
LINK("colour", colour)
CYCLE("link", "load moves", w->load.moved) /* it never waits: one is raised once the one before has the bus */
CYCLE("link", "fragments in a row", w->fragment.twice)
CYCLE("link", "colours in a row", w->colour.twice)

/* ---- slice generator, rasterizer, texture unit ---- */
CYCLE("slice", "the last of a visit", w->slice.moved && was->slice_generator.slice.last)
CYCLE("slice", "another", w->slice.moved && !was->slice_generator.slice.last)
CYCLE("rasterizer", "left column", w->fragment.moved && was->rasterizer.fragment.x == 0)
CYCLE("rasterizer", "right column", w->fragment.moved && was->rasterizer.fragment.x == w->c->view.width_px - 1)
CYCLE("rasterizer", "top row", w->fragment.moved && was->rasterizer.fragment.y == 0)
CYCLE("rasterizer", "bottom row", w->fragment.moved && was->rasterizer.fragment.y == w->c->view.height_px - 1)
CYCLE("rasterizer", "a visit ends", now->rasterizer.fragment.visit_done)
CYCLE("texture unit", "clamped on a near side", bins_clamps(w, false))
CYCLE("texture unit", "clamped on a far side", bins_clamps(w, true))
CYCLE("texture unit", "a weight of nothing", bins_weight(w, false))
CYCLE("texture unit", "the largest weight", bins_weight(w, true))
CYCLE("texture unit", "on a border of voxels", bins_on_border(w))
CYCLE("texture unit", "voxels from external memory", now->texture_unit.fetch.valid)
CYCLE("texture unit", "a fragment killed", w->colour.moved && was->texture_unit.colour.dead)
CYCLE("texture unit", "one that could be is not",
      w->colour.moved && m->kill_transparent && !was->texture_unit.colour.dead)
FRAME("texture unit", "killed in over", m->blend == VODR_BLEND_OVER && n->killed_fragments > 0)
FRAME("texture unit", "killed in under", m->blend == VODR_BLEND_UNDER && n->killed_fragments > 0)
FRAME("texture unit", "killed in maximum", m->blend == VODR_BLEND_MIP && n->killed_fragments > 0)
FRAME("texture unit", "all killed", n->killed_fragments > 0 && n->killed_fragments == n->fragments)
FRAME("texture unit", "a brick that is still there", DIVIDED &&SINGLE && w->load.moves < n->brick_visits)
FRAME("texture unit", "one buffer", DIVIDED && !m->double_buffer && n->brick_visits > 1)
FRAME("texture unit", "two buffers", DIVIDED && m->double_buffer && n->brick_visits > 1)
FRAME("texture unit", "a load of several bursts",
      DIVIDED &&SINGLE && n->texture_load_bytes > n->brick_visits * (uint64_t)m->texture_burst_bytes)

/* ---- alpha blender: how much source and pixel cover ---- */
#define COVERED(name, mode)                                                                                            \
    CYCLE("blend", name ": nothing on nothing", bins_blend(w, mode, 0, 0))                                             \
    CYCLE("blend", name ": nothing on some", bins_blend(w, mode, 0, 1))                                                \
    CYCLE("blend", name ": nothing on all", bins_blend(w, mode, 0, 2))                                                 \
    CYCLE("blend", name ": some on nothing", bins_blend(w, mode, 1, 0))                                                \
    CYCLE("blend", name ": some on some", bins_blend(w, mode, 1, 1))                                                   \
    CYCLE("blend", name ": some on all", bins_blend(w, mode, 1, 2))                                                    \
    CYCLE("blend", name ": all on nothing", bins_blend(w, mode, 2, 0))                                                 \
    CYCLE("blend", name ": all on some", bins_blend(w, mode, 2, 1))                                                    \
    CYCLE("blend", name ": all on all", bins_blend(w, mode, 2, 2))
COVERED("over", VODR_BLEND_OVER)
COVERED("under", VODR_BLEND_UNDER)
CYCLE("blend", "maximum: the first", bins_first(w))
CYCLE("blend", "maximum: less", bins_maximum(w, -1))
CYCLE("blend", "maximum: the same", bins_maximum(w, 0))
CYCLE("blend", "maximum: more", bins_maximum(w, 1))
CYCLE("blend", "white and opaque", w->blends && m->blend != VODR_BLEND_MIP && w->source == WHITE)
CYCLE("blend", "opaque, a channel of nothing", bins_opaque_without(w))
CYCLE("blend", "a pixel is not written", now->alpha_blender.blended.known && !now->alpha_blender.blended.known_writes)
FRAME("blend", "fragments terminated", n->terminated_fragments > 0)

/* ---- pixel cache ---- */
#define LOOK now->pixel_cache.look_up
CYCLE("cache", "hit", LOOK.valid && !LOOK.miss)
CYCLE("cache", "miss, an empty way", MISSES && !LOOK.replaced)
CYCLE("cache", "miss, replaced by lru", REPLACES && m->replacement == VODR_REPLACEMENT_LRU)
CYCLE("cache", "miss, replaced by fifo", REPLACES && m->replacement == VODR_REPLACEMENT_FIFO)
CYCLE("cache", "miss, replaced by random", REPLACES && m->replacement == VODR_REPLACEMENT_RANDOM)
CYCLE("cache", "replaced, one way", REPLACES && m->ways == 1)
CYCLE("cache", "replaced, one set", REPLACES &&SETS == 1)
CYCLE("cache", "replaced, index modulo", REPLACES &&SETS > 1 && m->index == VODR_INDEX_MODULO)
CYCLE("cache", "replaced, index xor", REPLACES &&SETS > 1 && m->index == VODR_INDEX_XOR)
CYCLE("cache", "replaced, layout linear", REPLACES && m->fb_layout == VODR_FB_LAYOUT_LINEAR)
CYCLE("cache", "replaced, layout tiled", REPLACES && m->fb_layout == VODR_FB_LAYOUT_TILED)
CYCLE("cache", "blocking miss", MISSES && !m->nonblocking)
CYCLE("cache", "hit under a miss", LOOK.valid && !LOOK.miss && w->fills > 0)
CYCLE("cache", "miss under a miss", MISSES && w->fills > 0)
CYCLE("cache", "as many misses as there may be",
      m->nonblocking && m->nonblocking_misses > 1 && w->fills == m->nonblocking_misses)
CYCLE("cache", "a line is wanted and one is written at once",
      now->pixel_cache.fill.valid && now->pixel_cache.write.valid)
CYCLE("cache", "a line comes while one is to be written", now->frame_buffer.filled.valid && w->writes > 0)
CYCLE("cache", "a pixel is written through",
      m->write_policy == VODR_WRITE_POLICY_THROUGH && now->pixel_cache.write.valid)
CYCLE("cache", "pixels wait to be written through", m->write_policy == VODR_WRITE_POLICY_THROUGH && w->writes > 1)
FRAME("cache", "clean lines replaced", BACK &&SINGLE && n->evictions > n->writebacks - w->flushed)
FRAME("cache", "dirty lines replaced", BACK &&SINGLE && n->writebacks > w->flushed)
FRAME("cache", "lines cleared at first touch",
      m->clear_on_first_touch &&SINGLE && n->fb_read_bytes < n->misses * LINE_BYTES)
FRAME("cache", "lines read at second touch", m->clear_on_first_touch && n->fb_read_bytes > 0)
FRAME("flush", "nothing is dirty", BACK &&SINGLE && n->fragments > 0 && w->flushed == 0)
FRAME("flush", "one line", BACK &&SINGLE && w->flushed == 1)
FRAME("flush", "several lines", BACK &&SINGLE && w->flushed > 1)
FRAME("flush", "every line of the cache", BACK &&SINGLE && w->flushed == (uint64_t)m->ways * SETS)
FRAME("flush", "none, written through", !BACK && n->fb_write_bytes > 0)

/* ---- who waits for what ---- */
CYCLE("stall", "divider: the slice generator", bins_stalled(&now->volume_divider.report, VODR_STALL_DIVIDER))
CYCLE("stall", "slice generator: the rasterizer", bins_stalled(&now->slice_generator.report, VODR_STALL_SLICE))
CYCLE("stall", "rasterizer: the brick", bins_stalled(&now->rasterizer.report, VODR_STALL_TEXTURE_LOAD))
CYCLE("stall", "rasterizer: the FIFO", bins_stalled(&now->rasterizer.report, VODR_STALL_FRAGMENT_FIFO))
CYCLE("stall", "texture unit: the brick", bins_stalled(&now->texture_unit.report, VODR_STALL_TEXTURE_LOAD))
CYCLE("stall", "texture unit: the FIFO", bins_stalled(&now->texture_unit.report, VODR_STALL_FRAGMENT_FIFO))
CYCLE("stall", "alpha blender: the cache", bins_stalled(&now->alpha_blender.report, VODR_STALL_CACHE))
CYCLE("stall", "alpha blender: a hazard", bins_stalled(&now->alpha_blender.report, VODR_STALL_HAZARD))
CYCLE("stall", "non-blocking cache: a hazard", bins_stalled(&now->pixel_cache.report, VODR_STALL_HAZARD))
CYCLE("stall", "blocking cache: a write-back",
      !m->nonblocking && bins_stalled(&now->pixel_cache.report, VODR_STALL_WRITE_BACK))
CYCLE("stall", "non-blocking cache: a write-back",
      m->nonblocking &&bins_stalled(&now->pixel_cache.report, VODR_STALL_WRITE_BACK))
CYCLE("stall", "blocking cache: a fill", !m->nonblocking && bins_stalled(&now->pixel_cache.report, VODR_STALL_FILL))
CYCLE("stall", "non-blocking cache: a fill", m->nonblocking &&bins_stalled(&now->pixel_cache.report, VODR_STALL_FILL))
CYCLE("stall", "frame buffer: a row", bins_stalled(&now->frame_buffer.report, VODR_STALL_DRAM_ROW))
CYCLE("stall", "frame buffer: a refresh", bins_stalled(&now->frame_buffer.report, VODR_STALL_DRAM_REFRESH))

/* ---- frame buffer ---- */
#define BEAT now->frame_buffer.memory
CYCLE("memory", "a beat is read", BEAT.read)
CYCLE("memory", "a beat is written", BEAT.write)
CYCLE("memory", "part of a beat", BEAT.valid &&BEAT.bytes < m->mem_bus_bytes)
CYCLE("memory", "fixed latency", BEAT.valid && m->memory == VODR_MEMORY_FIXED)
CYCLE("memory", "DRAM, row open: read", ROW(0) && BEAT.read)
CYCLE("memory", "DRAM, row open: write", ROW(0) && BEAT.write)
CYCLE("memory", "DRAM, none open: read", ROW(m->dram_trcd_cycles) && BEAT.read)
CYCLE("memory", "DRAM, none open: write", ROW(m->dram_trcd_cycles) && BEAT.write)
CYCLE("memory", "DRAM, another open: read", ROW(m->dram_trcd_cycles + m->dram_trp_cycles) && BEAT.read)
CYCLE("memory", "DRAM, another open: write", ROW(m->dram_trcd_cycles + m->dram_trp_cycles) && BEAT.write)
FRAME("memory", "DRAM without refresh", m->memory == VODR_MEMORY_DRAM && m->dram_refresh_cycles == 0)
FRAME("memory", "DRAM of one bank", m->memory == VODR_MEMORY_DRAM && m->dram_banks == 1)
CYCLE("memory", "line and brick wanted at once", now->pixel_cache.fill.valid && now->texture_unit.load.valid)
CYCLE("memory", "a line comes while a brick is loaded", now->frame_buffer.filled.valid && !now->frame_buffer.load.ready)
CYCLE("memory", "a brick's data come", now->frame_buffer.load.data_valid)
