/* Orogen: terrain from recipes.
 *
 * Functions return OROGEN_OK, or say in orogen_error() what is wrong and what to do instead. Worlds and samplers may
 * be used by any number of threads at the same time; chunks by one at a time. The first sample is in the north-west;
 * x is in metres east and y in metres south of the origin of the world; heights are in metres.
 *
 * The documentation is in docs/c.md.
 */

#ifndef OROGEN_H
#define OROGEN_H

#include <stddef.h>
#include <stdint.h>
#include <stdbool.h>

// The result of a call.
typedef enum {
  // The call did what it says.
  OROGEN_OK = 0,
  // The recipe is not valid.
  OROGEN_RECIPE = 1,
  // The world has no such window, layer or chunk, or an argument is not valid.
  OROGEN_REQUEST = 2,
  // The work needs more memory than it may have; it was not started.
  OROGEN_MEMORY = 3,
  // A file could not be read or written.
  OROGEN_FILE = 4,
  // The work was cancelled.
  OROGEN_CANCELLED = 5,
  // The library is wrong: please report the message.
  OROGEN_BUG = 6,
} OrogenStatus;

// The chunks around a viewer: which to make, nearest first, and which to drop. One thread at a time may use it; the
// chunks themselves are made from samplers on any thread.
typedef struct OrogenChunks OrogenChunks;

// The objects of a window.
typedef struct OrogenObjects OrogenObjects;

// A layer of a world that is ready to be read. It works on the calling thread, and may be used by any number of
// threads at the same time.
typedef struct OrogenSampler OrogenSampler;

// A world. It may be used by any number of threads at the same time.
typedef struct OrogenWorld OrogenWorld;

// What a world is.
typedef struct {
  // Whether the world ends; otherwise `width` and `height` are 0.
  bool is_bounded;
  // Length from west to east, in metres.
  double width;
  // Length from north to south, in metres.
  double height;
  // The world's own distance between samples, in metres.
  double cell;
  // Height of the sea, in metres.
  double sea_level;
  // The seed.
  uint64_t seed;
} OrogenWorldInfo;

// A lattice of samples: sample (i, j) is at ((x + i) * cell, (y + j) * cell) metres east and south of the origin.
typedef struct {
  // Index of the first column.
  int64_t x;
  // Index of the first row.
  int64_t y;
  // Number of columns.
  size_t width;
  // Number of rows.
  size_t height;
  // Distance between samples, in metres.
  double cell;
} OrogenWindow;

// How the terrain around a viewer is divided. `orogen_lod_default` has the defaults.
typedef struct {
  // Cells along a side of a chunk: an even number from 2 to 4096. A chunk has one sample more.
  size_t cells;
  // Distance between samples at level 0, in metres.
  double cell;
  // Number of levels, 1 to 24; each has cells twice as large as the one before.
  uint8_t levels;
  // Distance to the viewer below which a chunk is replaced by four finer ones, in sides of the chunk.
  double detail;
  // Range of sight, in metres.
  double range;
  // How much farther than that a chunk is kept, in sides of chunks, 0 to 1.
  double slack;
} OrogenLod;

// A chunk: a square of terrain at a level of detail. It is always the same terrain.
typedef struct {
  // Column among the chunks of its level.
  int64_t x;
  // Row among the chunks of its level.
  int64_t y;
  // Level of detail; 0 is the finest.
  uint8_t level;
} OrogenChunk;

// An object.
typedef struct {
  // Metres east of the origin.
  double x;
  // Metres south of the origin.
  double y;
  // Height of the ground, in metres.
  double height;
  // Scale factor.
  double size;
  // Rotation about the vertical axis in degrees, clockwise seen from above.
  double turn;
  // Number of its kind, whose name is `orogen_objects_kind`.
  uint32_t kind;
} OrogenObject;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The message of the last call of this thread that failed; an empty text if none did. It is valid until the next call
// of this thread fails. Never null.
const char *orogen_error(void);

// The version of the library, such as "0.1.0".
const char *orogen_version(void);

// Opens a preset by its name, or a recipe file (.toml, .json) or a file of heights by its path. Null after an error.
// Free it by `orogen_world_free`.
OrogenWorld *orogen_world_open(const char *source);

// Opens a recipe from its text, TOML or JSON. Errors name its place by `name`. `threads` and `memory` (in bytes) limit
// all work on this world; 0 stands for all processors and no limit. Null after an error. Free it by
// `orogen_world_free`.
OrogenWorld *orogen_world_parse(const char *recipe,
                                const char *name,
                                size_t threads,
                                uint64_t memory);

// Frees a world. Samplers and chunks that were made from it stay valid. Null does nothing.
void orogen_world_free(OrogenWorld *world);

// What a world is.
OrogenStatus orogen_world_info(const OrogenWorld *world, OrogenWorldInfo *info);

// The window of a whole bounded world at a distance between samples, in metres.
OrogenStatus orogen_world_whole(const OrogenWorld *world, double cell, OrogenWindow *window);

// Writes a layer of a window, such as "height", to `out`, row by row from the north-west. `count` is the number of
// samples that fit, and must be at least width * height.
OrogenStatus orogen_world_window(const OrogenWorld *world,
                                 const char *layer,
                                 OrogenWindow window,
                                 float *out,
                                 size_t count);

// Prepares a layer, such as "height": it is planned, and what it needs of the whole world is solved. Null after an
// error. Free it by `orogen_sampler_free`.
OrogenSampler *orogen_sampler_new(const OrogenWorld *world,
                                  const char *layer);

// Frees a sampler. Null does nothing.
void orogen_sampler_free(OrogenSampler *sampler);

// Writes the values at `count` points to `out`: `x` and `y` are in metres east and south of the origin.
OrogenStatus orogen_sampler_points(const OrogenSampler *sampler,
                                   const double *x,
                                   const double *y,
                                   size_t count,
                                   float *out);

// Writes the samples of a window to `out`, row by row from the north-west, without allocating memory if the layer has
// no filters. `count` is the number of samples that fit, and must be at least width * height.
OrogenStatus orogen_sampler_window(const OrogenSampler *sampler,
                                   OrogenWindow window,
                                   float *out,
                                   size_t count);

// The default division.
OrogenLod orogen_lod_default(void);

// The chunks of a world around a viewer, initially none. Null after an error. Free it by `orogen_chunks_free`.
OrogenChunks *orogen_chunks_new(const OrogenWorld *world,
                                OrogenLod lod);

// Frees chunks. Null does nothing.
void orogen_chunks_free(OrogenChunks *chunks);

// Sets the position of the viewer, in metres east and south of the origin.
OrogenStatus orogen_chunks_set_viewer(OrogenChunks *chunks, double x, double y);

// The nearest chunk that is to be made and was not yet taken. `has` is false if there is none.
OrogenStatus orogen_chunks_take(OrogenChunks *chunks, OrogenChunk *chunk, bool *has);

// A chunk that is to be dropped, because what replaces it has been made. `has` is false if there is none.
OrogenStatus orogen_chunks_evict(OrogenChunks *chunks, OrogenChunk *chunk, bool *has);

// Says that a chunk that was taken has been made.
OrogenStatus orogen_chunks_done(OrogenChunks *chunks, OrogenChunk chunk);

// Says that a chunk that was taken could not be made; it is taken again after all others.
OrogenStatus orogen_chunks_forget(OrogenChunks *chunks, OrogenChunk chunk);

// The samples of a chunk, including those on its far edges, which are its neighbors' first.
OrogenStatus orogen_chunks_window(const OrogenChunks *chunks, OrogenChunk chunk, OrogenWindow *window);

// The objects of a window, which is half open: adjacent windows share none. Null after an error, also if the recipe
// has no objects. Free them by `orogen_objects_free`.
OrogenObjects *orogen_objects_new(const OrogenWorld *world,
                                  OrogenWindow window);

// Frees objects. Null does nothing.
void orogen_objects_free(OrogenObjects *objects);

// The objects and their number. The pointer is valid until the objects are freed.
OrogenStatus orogen_objects_list(const OrogenObjects *objects, const OrogenObject **list, size_t *count);

// The name of a kind of objects, valid until the objects are freed; null if there is no such kind.
const char *orogen_objects_kind(const OrogenObjects *objects, uint32_t kind);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* OROGEN_H */
