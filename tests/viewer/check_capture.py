#!/usr/bin/python3
"""Captures a frame of the viewer with RenderDoc and checks its story: the cloth's dispatches and the draws stand in one
command buffer, in order, under readable labels, and the position buffer that is drawn is the one dispatched into.

usage: check_capture.py VIEWER SCENE     exit code 77: RenderDoc's Python module is not installed
"""
import pathlib
import re
import subprocess
import sys
import tempfile

try:
    import renderdoc as rd
except ImportError:
    print("RenderDoc's Python module is not installed")
    sys.exit(77)

# On GPUs, and on CPU devices.
SUBSTEPS = [["cloth rk4 stage"] * 4 + features + ["cloth contact"]
            for features in (["cloth feature tests", "cloth feature contact"],
                             ["cloth feature tests", "cloth feature contact", "cloth feature traversal"])]
# Before the first substep, and between substeps, with one cloth that collides with itself; the same devices.
TANGLES = ["cloth refit leaves", "cloth refit levels", "cloth find tangles"]
PAIRS = [["cloth pair means", "cloth pair clear"] + islands +
         ["cloth pair sweeps", "cloth pair boxes", "cloth refit levels", "cloth refit levels", "cloth find candidates",
          "cloth find pairs", "cloth match pairs", "cloth index pairs", "cloth meet pairs", "cloth respond to pairs"]
         for islands in ([], ["cloth find islands"])]
BUFFERS = pathlib.Path(__file__).parents[2] / "shaders/cloth/shared/buffers.h"


def expect(condition, message):
    if not condition:
        sys.exit(f"check_capture: {message}")


def capture_frame(viewer, scene, folder):
    command = [viewer, scene, "--headless", "--frames", "3", "--capture", "1", "--size", "320x180",
               "--cloth-resolution", "24", "--out", folder]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    expect(run.returncode == 0, f"the viewer failed: {run.stderr}")
    files = sorted(pathlib.Path(folder).glob("*.rdc"))
    expect(len(files) == 1, f"expected one capture, got {[f.name for f in files]}")
    expect("_frame1" in files[0].name, f"{files[0].name} does not name the frame")
    return files[0]


class Frame:
    """The actions of a capture with the labels above each."""

    def __init__(self, controller):
        self.controller = controller
        self.structured = controller.GetStructuredFile()
        self.steps = []  # (labels, action) of every dispatch and draw, in order
        self.command_buffers = []
        self.collect(controller.GetRootActions(), [])

    def collect(self, actions, labels):
        for action in actions:
            name = action.GetName(self.structured)
            if action.flags & (rd.ActionFlags.Dispatch | rd.ActionFlags.Drawcall):
                self.steps.append((labels, action))
            if "vkBeginCommandBuffer" in name:
                self.command_buffers.append(name)
            marker = action.flags & rd.ActionFlags.PushMarker
            self.collect(action.children, labels + [name] if marker else labels)

    def state_at(self, action):
        self.controller.SetFrameEvent(action.eventId, True)
        return self.controller.GetVulkanPipelineState()

    def bound_buffers(self, action):
        sets = self.state_at(action).compute.descriptorSets
        return {number: binding.binds[0].resourceResourceId
                for number, binding in enumerate(sets[0].bindings) if len(binding.binds) > 0}

    def drawn_positions(self, action):
        return self.state_at(action).vertexInput.vertexBuffers[0].resourceId


def check_order(frame):
    names = [labels[-1] for labels, _ in frame.steps]
    expect(len(frame.command_buffers) == 1, f"command buffers: {frame.command_buffers}")
    expect(all(labels[0] == "frame" for labels, _ in frame.steps), "a step is outside the label \"frame\"")
    dispatches = [labels[-1] for labels, action in frame.steps if action.flags & rd.ActionFlags.Dispatch]
    cloth = [labels for labels, _ in frame.steps if labels[1] == "cloth"]
    groups = {}
    between = []
    for labels in cloth:
        if len(labels) == 4:
            groups.setdefault(labels[2], []).append(labels[3])
        else:
            between.append((len(groups), labels[2]))
    count = len(groups)
    expect(count > 1 and list(groups) == [f"substep {k + 1}/{count}" for k in range(count)],
           f"groups of substeps: {list(groups)}")
    for k, (group, passes) in enumerate(groups.items()):
        # The second query has no workgroups unless there is no room for what the first one finds.
        queries = 2 * ["cloth near features"] if k == 0 else []
        expect(passes in [queries + substep for substep in SUBSTEPS], f"{group}: {passes}")
    for k in range(count + 1):
        passes = [name for substep, name in between if substep == k]
        if k == 0:
            expect(passes in [["cloth depenetrate"] + TANGLES + pairs for pairs in PAIRS], f"before the first substep: {passes}")
        elif k == count:
            expect(passes == ["cloth normals"], f"after the last substep: {passes}")
        else:
            expect(passes in PAIRS + [[]], f"after substep {k}: {passes}")
    expect(dispatches[len(cloth):] == ["cloth statistics", "cloth statistics reduce"], f"{dispatches[len(cloth):]}")
    order = [next(i for i, (labels, _) in enumerate(frame.steps) if label in labels)
             for label in ("cloth", "shadow map", "height map", "scene", "sky")]
    expect(order == sorted(order), f"passes begin at {order} of {names}")
    last_dispatch = max(i for i, (_, a) in enumerate(frame.steps) if a.flags & rd.ActionFlags.Dispatch)
    first_draw = min(i for i, (_, a) in enumerate(frame.steps) if a.flags & rd.ActionFlags.Drawcall)
    expect(last_dispatch < first_draw, "a draw comes before the last dispatch")


def binding_of(name):
    declared = re.search(rf"^VOILE_(?:BUFFER|ROLE)\((\d+), {name},", BUFFERS.read_text(), re.MULTILINE)
    expect(declared, f"{BUFFERS} declares no {name}")
    return int(declared.group(1))


def check_buffers(frame):
    contact = [action for labels, action in frame.steps if labels[-1] == "cloth contact"][-1]
    draws = [(labels, action) for labels, action in frame.steps
             if "cloth" in labels[-1:] and action.flags & rd.ActionFlags.Drawcall]
    views = {labels[-2] for labels, _ in draws}
    expect(views == {"shadow map", "height map", "scene"}, f"the cloth is drawn in {views}")
    bound = frame.bound_buffers(contact)
    # What contact.comp writes: the proposed state, in place, or the state before.
    written = [bound[binding_of(name)] for name in ("proposed_positions", "earlier_positions")]
    names = {r.resourceId: r.name for r in frame.controller.GetResources()}
    for labels, action in draws:
        drawn = frame.drawn_positions(action)
        expect(drawn in written, f"{labels[-2]}: draws from {drawn}, the contact pass writes one of {written}")
        expect(names[drawn] == "cloth positions", f"{labels[-2]}: draws from \"{names[drawn]}\"")


def check_names(frame):
    named = [resource.type for resource in frame.controller.GetResources() if resource.name == "cloth contact"]
    kinds = {"shader": rd.ResourceType.Shader, "pipeline": rd.ResourceType.PipelineState}
    for kind, value in kinds.items():
        expect(value in named, f"no {kind} is named as the kernel of contact")
    # The layouts of the pipeline and of its sets, and two sets at least.
    bindings = named.count(rd.ResourceType.ShaderBinding)
    expect(bindings >= 4, f"{bindings} layouts and descriptor sets are named as the kernel of contact")


def check(path):
    rd.InitialiseReplay(rd.GlobalEnvironment(), [])
    file = rd.OpenCaptureFile()
    expect(file.OpenFile(str(path), "", None) == rd.ResultCode.Succeeded, "the capture cannot be opened")
    result, controller = file.OpenCapture(rd.ReplayOptions(), None)
    expect(result == rd.ResultCode.Succeeded, "the capture cannot be replayed")
    frame = Frame(controller)
    check_order(frame)
    check_buffers(frame)
    check_names(frame)
    print(f"{len(frame.steps)} dispatches and draws in one command buffer, in order")
    controller.Shutdown()
    file.Shutdown()
    rd.ShutdownReplay()


def main():
    viewer, scene = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        check(capture_frame(viewer, scene, folder))


if __name__ == "__main__":
    main()
