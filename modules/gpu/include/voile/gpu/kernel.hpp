// Kernel: a compute pipeline over storage and uniform buffers. Its bindings, push constants and specialization
// constants are those that its SPIR-V declares.
#pragma once

#include "voile/gpu/buffer.hpp"
#include "voile/gpu/shader_interface.hpp"

#include <initializer_list>
#include <span>
#include <vector>

namespace voile::gpu
{

struct KernelDescription
{
    const char* name = nullptr; // label, pipeline name and timestamp name; a literal
    // SPIR-V of any version that the device takes: one compute entry point "main", whose descriptors are buffers of
    // set 0.
    std::span<const uint32_t> spirv;
    // A value for each specialization constant of the shader, and for no other. Id 0 is the workgroup size in x by
    // convention.
    std::vector<SpecializationConstant> specialization;
};

// What the shader declares. Errors: no compute entry point "main", a descriptor that is no buffer of set 0, an array of
// buffers, a specialization constant that is given no value or that the shader does not have; each names the kernel.
VOILE_GPU_API Result<ShaderInterface> reflect(const KernelDescription& description);

// Errors: those of reflect; more push-constant bytes, a larger workgroup, more shared memory or more storage buffers
// than `limits` allow.
VOILE_GPU_API Result<void> check_limits(const VkPhysicalDeviceLimits& limits, const KernelDescription& description);

class VOILE_GPU_API Kernel
{
public:
    Kernel() = default;
    ~Kernel();
    Kernel(Kernel&& other) noexcept;
    Kernel& operator=(Kernel&& other) noexcept;

    // Errors: those of check_limits, a driver that refuses the shader.
    static Result<Kernel> create(const Context& context, const KernelDescription& description);

    [[nodiscard]] const char* name() const { return name_; }
    [[nodiscard]] VkPipeline pipeline() const { return pipeline_; }
    [[nodiscard]] VkPipelineLayout layout() const { return layout_; }
    [[nodiscard]] VkDescriptorSetLayout set_layout() const { return set_layout_; }
    [[nodiscard]] const std::vector<ShaderBinding>& bindings() const { return bindings_; } // ascending by number
    [[nodiscard]] uint32_t push_bytes() const { return push_bytes_; }

private:
    void release();

    Context context_;
    const char* name_ = nullptr;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    std::vector<ShaderBinding> bindings_;
    uint32_t push_bytes_ = 0;
};

// A buffer for the binding of that number: all of it, or a range.
//
// Two bindings of a kernel may have the same memory, one of them "readonly". Compilers, and Context::texel_reads, take
// them for different memory (SPIR-V, "Aliasing"): an entry that a dispatch writes may be read through the readonly
// binding by the thread that writes it alone, before it does.
struct BufferBinding
{
    uint32_t number = 0;
    VkBuffer buffer = VK_NULL_HANDLE;
    // Bytes; a multiple of minStorageBufferOffsetAlignment or minUniformBufferOffsetAlignment, and where the context
    // has texel_reads, of minTexelBufferOffsetAlignment.
    VkDeviceSize offset = 0;
    // Up to the end of the last entry that the kernel reads, or further; a multiple of 4. VK_WHOLE_SIZE: all that the
    // VkBuffer has, which may be more than create_buffer was asked for. Kernels that use .length() need exact bytes.
    VkDeviceSize bytes = VK_WHOLE_SIZE;
};

// Descriptor sets of one pool, written once when they are made.
class VOILE_GPU_API BindingPool
{
public:
    BindingPool() = default;
    ~BindingPool();
    BindingPool(BindingPool&& other) noexcept;
    BindingPool& operator=(BindingPool&& other) noexcept;

    // `max_buffers`: storage buffers of all sets.
    static Result<BindingPool> create(const Context& context, uint32_t max_sets, uint32_t max_buffers,
                                      uint32_t max_uniform_buffers = 0);

    // A set for `kernel`, with one buffer for each of its bindings, in any order. The set lives as long as the pool.
    // Errors, which name the kernel and the binding: a binding without a buffer or with two, a number that the kernel
    // does not have. Error where the pool's sets or buffers are used up, whatever the driver has beyond them.
    Result<VkDescriptorSet> bind(const Kernel& kernel, std::span<const BufferBinding> buffers);
    Result<VkDescriptorSet> bind(const Kernel& kernel, std::initializer_list<BufferBinding> buffers)
    {
        return bind(kernel, std::span(buffers.begin(), buffers.size()));
    }

private:
    Result<VkBufferView> create_view(const BufferBinding& given, uint32_t texel_bytes);

    Context context_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    std::vector<VkBufferView> views_; // of texels
    uint32_t sets_left_ = 0;
    uint32_t buffers_left_ = 0;
    uint32_t uniform_buffers_left_ = 0;
};

} // namespace voile::gpu
