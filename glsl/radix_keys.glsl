// The keys that the pipelines of the sort for GPUs sort: those of the splats, or the macro-tiles of the pairs of macro-tile
// and splat (src/passes/bin/macro_tiles.rs), of which no pass is skipped, and above whose bits the keys hold more.
#ifndef RARA_RADIX_KEYS
#define RARA_RADIX_KEYS

layout(constant_id = 0) const bool PAIRS = false;

#define KEY_COUNT (PAIRS ? counts.at[0].macro_pairs : counts.at[0].visible + counts.at[0].cutoff)
#define KEY_BASE (PAIRS ? 0u : counts.at[0].sort_base)
#define SORTED_BITS(key) (PAIRS ? bitfieldExtract(key, 0, int(PAIR_BITS)) : key)
#define KEY_DIGIT (PAIRS ? push.params.pass : push.params.pass - counts.at[0].sort_skipped)

#endif
