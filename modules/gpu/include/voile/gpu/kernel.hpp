// Kernel: a compute pipeline whose bindings are storage buffers 0..n-1 of descriptor set 0.
#pragma once

#include "voile/gpu/buffer.hpp"

#include <initializer_list>
#include <span>
#include <vector>

namespace voile::gpu
{

struct KernelDescription
{
    const char* name = nullptr;           // label, pipeline name and timestamp name; a literal
    std::span<const uint32_t> spirv;      // one compute entry point "main"
    uint32_t buffers = 0;                 // storage buffers, bindings 0..buffers-1
    uint32_t push_bytes = 0;              // size of the push-constant block, at most 128
    std::vector<uint32_t> specialization; // constant_id 0 is the workgroup size in x by convention
};

// Errors: more push-constant bytes, a larger workgroup, more shared memory or more storage buffers than `limits` allow.
Result<void> check_limits(const VkPhysicalDeviceLimits& limits, const KernelDescription& description);

class Kernel
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
    [[nodiscard]] uint32_t buffers() const { return buffers_; }
    [[nodiscard]] uint32_t push_bytes() const { return push_bytes_; }

private:
    void release();

    Context context_;
    const char* name_ = nullptr;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    uint32_t buffers_ = 0;
    uint32_t push_bytes_ = 0;
};

// Descriptor sets of one pool, written once when they are made.
class BindingPool
{
public:
    BindingPool() = default;
    ~BindingPool();
    BindingPool(BindingPool&& other) noexcept;
    BindingPool& operator=(BindingPool&& other) noexcept;

    static Result<BindingPool> create(const Context& context, uint32_t max_sets, uint32_t max_buffers);

    // Binds `buffers` (one per binding, in order, whole) for `kernel`. The set lives as long as the pool. Error if the
    // pool's sets or buffers are used up, even if the driver has more.
    Result<VkDescriptorSet> bind(const Kernel& kernel, std::initializer_list<VkBuffer> buffers);

private:
    Context context_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    uint32_t sets_left_ = 0;
    uint32_t buffers_left_ = 0;
};

} // namespace voile::gpu
