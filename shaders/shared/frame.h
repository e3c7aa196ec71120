// SPDX-License-Identifier: Apache-2.0
// Cameras, visibility and the parameters of the kernels of a frame.
#ifndef FIELDCAST_SHARED_FRAME_H
#define FIELDCAST_SHARED_FRAME_H
#include "lists.h"

SHARED_BEGIN

// A pinhole as in core/lightfield/camera.h.
struct CameraRecord {
    vec3 origin;      // world space, metres
    float focal_px;
    vec3 right;       // unit vectors, world space
    float principal_x;
    vec3 up;
    float principal_y;
    vec3 forward;
    uint size_px;     // width | height << 16
};
SHARED_BUFFER(CameraBuffer, CameraRecord);

// The visible surface of a pixel: the first one that is not BLEND.
struct Visibility {
    uint instance;    // kNoInstance: nothing
    uint primitive;
};
SHARED_BUFFER(VisibilityBuffer, Visibility);

// visibility.comp: the visible surface of every pixel of `view_count` cameras of equal size.
struct VisibilityParams {
    CameraBuffer cameras;
    VisibilityBuffer visibility; // out: view_count × width × height
    VisibilityBuffer layers;     // out: two BLEND surfaces per pixel in front of it, nearest first; only with has_blend
    uint width;
    uint height;
    uint view_count;
    uint unused;
};

// draw_visibility.vert, .frag: triangles of one rigid group in one view.
struct DrawParams {
    mat4 clip_from_group;
    CameraBuffer camera;        // of the view, at 0
    VisibilityBuffer triangles; // by number
};

// name_triangles.comp: converts the numbers of drawn triangles into visible surfaces of pixels.
struct NameTrianglesParams {
    UintBuffer numbers;          // view_count × view_stride()
    VisibilityBuffer triangles;
    VisibilityBuffer visibility; // out
    uint pixel_count;
    uint triangle_count;
};

// find_layers.comp: the layers of VisibilityParams for views that were drawn.
struct FindLayersParams {
    CameraBuffer cameras;
    VisibilityBuffer visibility;
    VisibilityBuffer layers; // out
    UintBuffer marks;        // a byte per pixel, 1: it may have layers
    uint width;
    uint height;
};

// Sources have pages (core/lightfield/source_frame.h): page layer · source_count + source. Layer 0 holds the visible
// surfaces (Visibility), layers 1 and 2 the BLEND surfaces in front of them, nearest first; only scenes with BLEND
// surfaces have them. Arrays over the sources hold one page after the other.
const uint kMaxLayers = 2;
const uint kMaxSources = 8; // as core/lightfield/source_frame.h

const uint kFlagTemporal = 2;
const uint kFlagAces = 4;
const uint kFlagKeepTaps = 8;
const uint kFlagReflections = 16;
const uint kFlagSharpHistory = 32;
const uint kFlagFollowLobes = 64;
const uint kFlagKeepLight = 128;
const uint kFlagPunctualApart = 256;

// Settings of path tracing, in one word: the largest number of bounces, then the candidates of a light sample, then
// kPath….
const uint kPathCandidatesShift = 16;
const uint kPathNextEventEstimation = 1u << 24;
const uint kPathEachLightKind = 1u << 25;
const uint kPathScreenSampler = 1u << 26;
const uint kPathPunctualApart = 1u << 27;
const uint kPathEndsInHistory = 1u << 28;

// trace_source.comp: path traces every pixel of the sources, every page.
struct TraceSourceParams {
    CameraBuffer cameras;
    VisibilityBuffer visibility;
    VisibilityBuffer layers;
    UintBuffer tiles;            // to run on; pixels without a surface are 0 or left alone
    Vec4Buffer diffuse;          // out: rgb demodulated illumination, a 0
    Vec4Buffer specular;         // out
    Vec4Buffer punctual; // out, with kPathPunctualApart: the part of diffuse that comes directly from such lights
    UintBuffer invalid_samples;  // counter
    Uvec4Buffer previous_geometry; // with kPathEndsInHistory: GeometryTexel of the frame before
    UintBuffer previous_diffuse;   // … and its wire planes
    UintBuffer previous_specular;
    uint width;
    uint height;
    uint seed;
    uint first_sample;           // number of the first sample in the pixels' sequences
    uint samples_per_pixel;
    uint source_count;
    uint path;                   // kPath…
    float max_indirect;
};

// trace_reference.comp: path traces a view without any reuse.
struct TraceReferenceParams {
    CameraBuffer camera;
    Vec4Buffer film;             // in/out: sum of radiance, number of samples
    UintBuffer invalid_samples;
    uint width;
    uint height;
    uint seed;
    uint first_sample;
    uint samples_per_pixel;
    uint path;                   // kPath…
    float max_indirect;          // 0: unbiased
};

// source_surfaces.comp: G-buffer planes of the sources from their visibility.
struct SourceSurfacesParams {
    CameraBuffer cameras;
    VisibilityBuffer visibility;
    VisibilityBuffer layers;
    FloatBuffer depth;    // out: wire planes
    UintBuffer normal;
    UintBuffer id;
    UintBuffer material;
    Uvec4Buffer geometry; // out: GeometryTexel
    UintBuffer flags;     // out: not 0 for groups of kLinearGroup pixels with a surface; the others are left alone
    UintBuffer tile_flags; // likewise for tiles
    uint width;
    uint height;
    uint page_count;
    uint source_count;
};

// merge_light.comp: diffuse and specular illumination of the sources as one.
struct MergeLightParams {
    CameraBuffer cameras;
    VisibilityBuffer visibility;
    VisibilityBuffer layers;
    UintBuffer diffuse;  // wire planes
    UintBuffer specular;
    UintBuffer light;    // out, likewise
    uint width;
    uint height;
    uint page_count;
    uint source_count;
};

// Surface of a source's pixel for filters, as one RGBA32UI texel: view depth (bits), packed normal, id, roughness |
// metallic.
struct GeometryTexel {
    float depth;
    uint normal;
    uint id;
    uint material;
};

// Pixels of the previous frame that entered a pixel's history.
struct HistoryTaps {
    vec2 position; // image position, pixels
    uint accepted; // bits 0 to 3: the bilinear taps, x first; 4 to 12: the 3×3 pixels around, row by row, with weight 1
};
SHARED_BUFFER(HistoryTapsBuffer, HistoryTaps);

// temporal.comp: blends the frame with the reprojected history. Reads set 1: kTemporal….
struct TemporalParams {
    CameraBuffer cameras;        // of the sources now, then as they were
    VisibilityBuffer visibility;
    VisibilityBuffer layers;
    Vec4Buffer diffuse;          // in: noisy; out: accumulated, a = variance of luminance
    Vec4Buffer specular;
    Vec4Buffer moments;          // out: first and second moment of luminance, diffuse then specular
    Vec4Buffer punctual;         // out, with kFlagPunctualApart: rgb, a = second moment of luminance
    FloatBuffer history_length;  // out: frames
    HistoryTapsBuffer taps;      // out, with kFlagKeepTaps
    UintBuffer groups;           // to run on
    uint width;
    uint height;
    uint page_count;
    uint source_count;
    uint flags;                  // kFlagTemporal: there is a history; kFlagKeepTaps
    float alpha;                 // least weight of the new frame in illumination
    float moments_alpha;         // … and in the moments
};
const uint kTemporalGeometry = 0;          // GeometryTexel, current
const uint kTemporalPreviousGeometry = 1;  // GeometryTexel
const uint kTemporalPreviousDiffuse = 2;   // rgb
const uint kTemporalPreviousSpecular = 3;
const uint kTemporalPreviousMoments = 4;
const uint kTemporalPreviousLength = 5;    // R32F
const uint kTemporalDiffuse = 6;           // noisy input
const uint kTemporalSpecular = 7;
const uint kTemporalPunctual = 8;          // noisy input
const uint kTemporalPreviousPunctual = 9;

// svgf_variance.comp, limit_history.comp and svgf_atrous.comp. Read set 1: kFilter….
struct FilterParams {
    CameraBuffer cameras; // of the sources
    Vec4Buffer diffuse;  // out: rgb, a = variance
    Vec4Buffer specular;
    UintBuffer groups;   // to run on
    uint width;
    uint height;
    uint page_count;
    uint source_count;
    uint step;           // pixels between taps
    float sigma_luminance;
    float sigma_depth;
    uint normal_squarings; // σ of the normals is 2 to this power
    int radius;            // svgf_atrous.comp: taps on each side, 1 or 2
    uint follows_lobes;    // specular light is shared only between pixels that mirror about the same
    uint limits_outliers;  // svgf_atrous.comp: no pixel stays brighter than all around it on its surface
    float alpha;           // limit_history.comp: least weight of a frame in the illumination
};
const uint kFilterGeometry = 0;
const uint kFilterDiffuse = 1;
const uint kFilterSpecular = 2;
const uint kFilterMoments = 3;
const uint kFilterLength = 4;

// filter_punctual.comp: one level over light that comes straight from punctual lights. Reads set 1: kFilter…, of which
// kFilterDiffuse is that light: rgb, a = second moment of luminance in the first level, variance later.
struct FilterPunctualParams {
    CameraBuffer cameras;
    Vec4Buffer punctual; // out: rgb, a = variance
    UintBuffer groups;   // to run on
    uint width;
    uint height;
    uint page_count;
    uint source_count;
    uint step;           // pixels between taps
    float sigma_luminance;
    float sigma_depth;
    uint normal_squarings;
    int radius;
    uint has_moments;    // the first level
    float alpha;         // least weight of a frame in this light
};

// pack_source.comp: illumination into wire precision; 0 where there is no surface.
struct PackParams {
    UintBuffer id;
    Vec4Buffer diffuse_in;
    Vec4Buffer specular_in;
    Vec4Buffer punctual_in; // added to diffuse, with is_punctual_apart
    UintBuffer diffuse;  // out: R11G11B10F
    UintBuffer specular;
    uint first_pixel;    // of all pages
    uint pixel_count;
    uint is_punctual_apart;
};

// interleave_source.comp: wire planes into the texels that reproject.comp reads.
struct InterleaveParams {
    UintBuffer diffuse;
    UintBuffer specular;
    FloatBuffer depth;
    UintBuffer normal;
    UintBuffer id;
    UintBuffer material;
    Uvec4Buffer geometry;     // out: GeometryTexel
    Uvec2Buffer illumination; // out: diffuse, specular
    uint pixel_count;         // of all pages
};

// Data of one target view besides its camera.
struct ViewRecord {
    uint seed;                // hash of frame seed and lattice position
    uint is_corner;           // of the hole cascade
};
SHARED_BUFFER(ViewBuffer, ViewRecord);

// Counters of a batch of views: lists (length, then the group counts of an indirect dispatch), events, kDiscard… per
// view.
const uint kCounterHoles = 0;
const uint kCounterLayers = 4;          // pixels behind BLEND surfaces
const uint kCounterFirstHoles = 8;      // holes to be traced first: of corner views, or all of them
const uint kCounterInnerHoles = 12;     // holes that corner views may fill
const uint kCounterRestHoles = 16;      // those that the corner views did not fill
const uint kCounterInvalidSamples = 20;
const uint kCounterLayerPaths = 21;     // BLEND surfaces that had to be path traced
const uint kCounterRememberedHoles = 22; // filled from the frame before
const uint kCounterIsolatedHoles = 23;  // filled from around their place in the source
const uint kCounterReflections = 24;    // pixels of smooth surfaces
const uint kCounterDiscards = 32;       // 4 per view
const uint kDiscardFrustum = 0;
const uint kDiscardId = 1;
const uint kDiscardPlane = 2;
const uint kDiscardNormal = 3;

struct ReprojectSettings {
    float plane_footprints;
    float tangential_footprints;
    float min_normal_cos;
    float min_weight;
    uint source_count;
};

// Light of views that is averaged or filtered before it meets their own materials. Each view is a page, without
// padding.
struct ViewLight {
    Uvec4Buffer geometry; // GeometryTexel
    Vec4Buffer diffuse;   // rgb
    Vec4Buffer specular;
};

// reproject.comp: every pixel of every view. Reads set 1: kReproject….
struct ReprojectParams {
    CameraBuffer cameras;        // kMaxSources (guard band included), then the views
    VisibilityBuffer visibility; // of the views
    VisibilityBuffer layers;
    Uvec2Buffer radiance;        // out: linear radiance, half floats
    UintBuffer holes;            // in/out: the map of shared/holes.h
    UintBuffer layer_pixels;     // out
    UintBuffer glossy_pixels;    // out, with kFlagReflections
    UintBuffer counters;
    ViewLight light;             // out, with kFlagKeepLight, instead of the radiance of surfaces
    uint width;
    uint height;
    uint view_count;
    uint flags;                  // kFlagReflections: lists pixels for reflect_views.comp; kFlagKeepLight
    ReprojectSettings settings;
};
const uint kReprojectGeometry = 0;     // RGBA32UI GeometryTexel
const uint kReprojectIllumination = 1; // RG32UI: diffuse, specular (R11G11B10F)

// shade_views.comp: radiance of views from their light.
struct ShadeViewsParams {
    CameraBuffer cameras;        // of the views
    VisibilityBuffer visibility;
    Uvec2Buffer radiance;        // out: of pixels that see a surface
    Vec4Buffer diffuse;          // pages, as in ViewLight
    Vec4Buffer specular;
    uint width;
    uint height;
    uint view_count;
};

// composite_layers.comp: the pixels behind BLEND surfaces; reflect_views.comp: those of smooth surfaces. Read set 1:
// kReproject….
struct TraceListParams {
    CameraBuffer cameras;        // kMaxSources, then the views
    VisibilityBuffer visibility;
    VisibilityBuffer layers;
    Uvec2Buffer radiance;
    UintBuffer list;
    UintBuffer counters;
    ViewBuffer views;
    uint width;
    uint height;
    uint samples_per_pixel;
    uint path;                   // kPath…
    float max_indirect;
    uint layer_count;            // of the sources
    ReprojectSettings settings;
};

// tone_map.comp: linear radiance to packed RGB8; one invocation makes four pixels (three words).
struct ToneMapParams {
    Uvec2Buffer radiance;
    UintBuffer rgb8;             // out
    uint pixel_count;            // of all views, a multiple of 4 per view
    uint flags;
    float exposure;
};

SHARED_END
#endif
