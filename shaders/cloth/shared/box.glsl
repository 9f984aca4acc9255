// Axis-aligned boxes.
#ifndef VOILE_BOX_GLSL
#define VOILE_BOX_GLSL

struct Box
{
    vec3 min;
    vec3 max;
};

bool overlap(Box a, Box b) { return all(lessThanEqual(a.min, b.max)) && all(lessThanEqual(b.min, a.max)); }

Box box_around(vec3 a, vec3 b) { return Box(min(a, b), max(a, b)); }
Box joined(Box a, Box b) { return Box(min(a.min, b.min), max(a.max, b.max)); }
Box grown(Box box, float margin) { return Box(box.min - margin, box.max + margin); }
Box shifted(Box box, vec3 displacement) { return Box(box.min + displacement, box.max + displacement); }

#endif
