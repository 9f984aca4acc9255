// The sizes of a batch's dispatches for vertices whose items do not suffice, on CPU devices (VOILE_TRAVERSAL_*).
//
// The including kernel declares traversals[].
#ifndef VOILE_TRAVERSAL_SIZE_GLSL
#define VOILE_TRAVERSAL_SIZE_GLSL

// `first`: the batch's word.
void write_traversal(uint first, uint pass, uint patches)
{
    const uint word = first + 3 * (pass & 1);
    traversals[word] = patches;
    traversals[word + 1] = traversals[word + 2] = 1;
}

#endif
