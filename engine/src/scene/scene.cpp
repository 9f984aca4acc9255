// Scene: calls the hooks of all components, in the order of their creation.
#include "voile/engine/scene/scene.hpp"

namespace voile::engine
{

Entity& Scene::add(std::string name)
{
    entities_.push_back(std::make_unique<Entity>(std::move(name)));
    return *entities_.back();
}

void Scene::clear()
{
    while (!entities_.empty())
        entities_.pop_back();
}

void Scene::update(const FrameInfo& frame) const
{
    for (const auto& entity : entities_)
        for (const auto& component : entity->components())
            component->update(frame);
}

void Scene::record_compute(VkCommandBuffer cmd, const FrameInfo& frame) const
{
    for (const auto& entity : entities_)
        for (const auto& component : entity->components())
            component->record_compute(cmd, frame);
}

void Scene::record_draw(VkCommandBuffer cmd, View& view) const
{
    for (const auto& entity : entities_)
        for (const auto& component : entity->components())
            component->record_draw(cmd, view);
}

} // namespace voile::engine
