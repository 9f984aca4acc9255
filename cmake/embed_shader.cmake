# Turns a SPIR-V file into a C++ source that defines a span of its words. -DINPUT -DOUTPUT -DNAMESPACE -DSYMBOL
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1,\n" words "${bytes}")
file(WRITE ${OUTPUT} "// Generated from a shader; do not edit.
#include <cstdint>
#include <span>
namespace ${NAMESPACE}
{
namespace
{
constexpr uint32_t ${SYMBOL}_words[] = {
${words}};
}
extern const std::span<const uint32_t> ${SYMBOL};
const std::span<const uint32_t> ${SYMBOL}{${SYMBOL}_words};
}
")
