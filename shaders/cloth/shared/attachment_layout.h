// Anchors, attachments and tethers, as the GPU reads them.
#ifndef VOILE_ATTACHMENT_LAYOUT_H
#define VOILE_ATTACHMENT_LAYOUT_H

#include "../../shared_types.h"

VOILE_SHARED_BEGIN(voile)

// A frame that attachments follow, before and after the step.
struct AnchorRecord
{
    mat4 from; // world from anchor
    mat4 to;
    mat4 motion; // to * inverse(from)
};

// Flags of an attachment.
#define VOILE_ATTACHMENT_PLACED 1u // its position is given; otherwise a pin starts where its vertex is
#define VOILE_ATTACHMENT_BACKSTOP 2u

// An attachment of a vertex. Pins come first, then the others.
struct AttachmentRecord
{
    vec3 position; // m, in the anchor's space
    uint vertex;   // in the solver's buffers
    vec3 normal;   // of the backstop, in the anchor's space
    uint anchor;
    float stiffness;    // N/m
    float damping;      // N s/m
    float max_distance; // m; infinite: no bound
    float backstop;     // m, behind the position
    uint flags;
    uint cloth;
    uint padding_0;
    uint padding_1;
};

#define VOILE_TETHERS 4

// The tethers of one vertex.
struct TetherRecord
{
    uint vertex; // in the solver's buffers, as the pins are
    uint count;  // 1..VOILE_TETHERS
    uint cloth;
    uint padding;
    uint pins[VOILE_TETHERS];
    float lengths[VOILE_TETHERS]; // m
};

// Push constants of the passes over attachments and tethers.
struct AttachmentPush
{
    uint first; // of the records
    uint count;
    float substeps; // of level 0, in the substep; 0: no time passes
    float progress; // 0..1, of the step, at the substep's end
};

// Push constants of the pass over pins.
struct PinPush
{
    uint first; // of the records
    uint count;
    float step; // s, of the whole step; 0 if their cloths are disabled
};

#ifdef __cplusplus
static_assert(sizeof(AnchorRecord) == 192);
static_assert(sizeof(AttachmentRecord) == 64);
static_assert(offsetof(AttachmentRecord, normal) == 16);
static_assert(sizeof(TetherRecord) == 48);
#endif

VOILE_SHARED_END

#endif
