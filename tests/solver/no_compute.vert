#version 460
// For tests: a shader that is no kernel.
void main() { gl_Position = vec4(0); }
