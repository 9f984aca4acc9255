// Scene: entities with a transform and components, a camera and a sun.
#pragma once

#include "voile/engine/scene/component.hpp"

#include <memory>
#include <string>
#include <vector>

namespace voile::engine
{

struct Camera
{
    glm::vec3 position{0, 2, 5};
    glm::vec3 target{0, 1, 0};
    float fov = 40; // vertical field of view, degrees
};

struct Sun
{
    glm::vec3 direction{-0.55f, -0.75f, -0.3f}; // direction of the light's travel; need not be unit length
    glm::vec3 irradiance{4.4f, 4.0f, 3.4f};     // linear; of a surface that faces the sun
};

class Entity
{
public:
    explicit Entity(std::string name) : name_(std::move(name)) {}

    [[nodiscard]] const std::string& name() const { return name_; }

    // Builds a component in place and returns it. The entity owns it.
    template <typename T, typename... Arguments>
    T& add(Arguments&&... arguments)
    {
        auto component = std::make_unique<T>(std::forward<Arguments>(arguments)...);
        T& result = *component;
        components_.push_back(std::move(component));
        return result;
    }

    [[nodiscard]] const std::vector<std::unique_ptr<Component>>& components() const { return components_; }

private:
    std::string name_;
    std::vector<std::unique_ptr<Component>> components_;
};

class Scene
{
public:
    Camera camera;
    Sun sun;
    // Center of the area that the shadow map must cover and that the ground fades around; m.
    glm::vec3 focus{0, 1, 0};
    float focus_radius = 3;

    Entity& add(std::string name);
    // Destroys all entities, the last first. The device must not use them.
    void clear();
    [[nodiscard]] const std::vector<std::unique_ptr<Entity>>& entities() const { return entities_; }

    void update(const FrameInfo& frame) const;
    void record_compute(VkCommandBuffer cmd, const FrameInfo& frame) const;
    void record_draw(VkCommandBuffer cmd, View& view) const;

private:
    std::vector<std::unique_ptr<Entity>> entities_; // by pointer: components may keep references to their entity
};

} // namespace voile::engine
