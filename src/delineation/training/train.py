"""Trains the network that finds the borders of fragments, on simulated photos alone.

    cargo run --release -p fragscale-sample --example training_photos -- TRAIN 1 160 512
    cargo run --release -p fragscale-sample --example training_photos -- VALID 2 8 512
    python3 piles.py MORE 11 100                                 # piles of more kinds
    python3 train.py TRAIN,MORE VALID --to OUT [--steps 1500] [--from fragments.onnx]
    python3 train.py TRAIN VALID --to PATCHES --patches 300      # for train_score.py

Needs torch, numpy, pillow and onnx; two cores and an hour. No photo of the world is used: the labels of
simulated photos are exact, and their licence is ours. What happens to a pile, and what lens, sensor and file
do to its photo, is drawn anew for every step (`harder`, `patch`): broken faces, joints, bedding, mud and dust
over stones and what is between them, fines brighter or darker than rock, hard shadows; zoom, turn, light, fog,
colour or grey, blur, motion, sharpening, evened contrast, noise, JPEG. Everything follows from the seed; on
another machine the weights differ in their last digits.

The weights that ship are older than `harder`, `--from` and piles.py: this script as of commit 5f32745 made them.
assets/delineation/trials.log has what these gave so far.

The network is a U-Net of five levels. In: RGB, less the photo's mean, over its standard deviation
(both over all pixels and channels). Out, each between 0 and 1: border (a pixel beside another fragment or
what is none), rock (a fragment rather than fines, floor, anything else), middle (0 at a fragment's border,
1 where its largest inscribed circle has its centre).
"""
import argparse
import io
import pathlib
import time

import numpy as np
import torch
import torch.nn as nn
import torch.nn.functional as F
from PIL import Image

SIDE = 256
BATCH = 6
# Smaller fragments are fines to a photo.
LEAST_PIXELS = 16
CHANNELS = [12, 24, 36, 48, 64]


class Block(nn.Module):
    def __init__(self, before, after):
        super().__init__()
        layers = []
        for channels in (before, after):
            layers += [nn.Conv2d(channels, after, 3, padding=1, bias=False), nn.BatchNorm2d(after), nn.ReLU()]
        self.layers = nn.Sequential(*layers)

    def forward(self, x):
        return self.layers(x)


class Net(nn.Module):
    def __init__(self):
        super().__init__()
        c = CHANNELS
        self.down = nn.ModuleList([Block(before, after) for before, after in zip([3] + c, c)])
        self.up = nn.ModuleList([Block(c[i] + c[i + 1], c[i]) for i in reversed(range(len(c) - 1))])
        self.head = nn.Conv2d(c[0], 3, 1)

    def forward(self, x):
        seen = []
        for level, block in enumerate(self.down):
            x = block(F.max_pool2d(x, 2) if level else x)
            seen.append(x)
        for block, beside in zip(self.up, reversed(seen[:-1])):
            x = F.interpolate(x, scale_factor=2.0, mode="nearest")
            x = block(torch.cat([beside, x], 1))
        return self.head(x)


def load(folder):
    pairs = []
    for folder in map(pathlib.Path, folder.split(",")):
        for photo in sorted((folder / "photos").glob("*.png")):
            label = np.array(Image.open(folder / "labels" / photo.name)).astype(np.int32)
            pairs.append((np.array(Image.open(photo).convert("RGB")), label))
    return pairs


def blurred(image, kernel):
    """Along both axes by a kernel of an odd length, or by one of two dimensions."""
    t = torch.from_numpy(np.ascontiguousarray(image.transpose(2, 0, 1), dtype=np.float32))[:, None]
    if kernel.ndim == 1:
        k = torch.from_numpy(kernel.astype(np.float32))
        r = len(kernel) // 2
        t = F.conv2d(F.pad(t, (r, r, 0, 0), mode="reflect"), k[None, None, None, :])
        t = F.conv2d(F.pad(t, (0, 0, r, r), mode="reflect"), k[None, None, :, None])
    else:
        r = kernel.shape[0] // 2
        t = F.conv2d(F.pad(t, (r, r, r, r), mode="reflect"), torch.from_numpy(kernel.astype(np.float32))[None, None])
    return t[:, 0].numpy().transpose(1, 2, 0)


def gauss(sigma):
    r = max(1, int(np.ceil(3 * sigma)))
    k = np.exp(-0.5 * (np.arange(-r, r + 1) / max(sigma, 1e-3)) ** 2)
    return k / k.sum()


def slow_noise(rng, cells, size):
    """Between -1 and 1, over a patch of that size."""
    coarse = rng.uniform(-1, 1, (cells, cells)).astype(np.float32)
    t = torch.from_numpy(coarse)[None, None]
    return F.interpolate(t, size=(size, size), mode="bicubic", align_corners=False)[0, 0].numpy()[..., None]


def stones_of(label):
    """The labels from 0 without gaps, how many there are, their middles and radii."""
    _, own = np.unique(label, return_inverse=True)
    own = own.reshape(label.shape)
    if label.min() > 0:
        own = own + 1
    count = int(own.max()) + 1
    area = np.bincount(own.ravel(), minlength=count).astype(np.float32)
    ys, xs = np.mgrid[:label.shape[0], :label.shape[1]].astype(np.float32)
    x = np.bincount(own.ravel(), xs.ravel(), count) / np.maximum(area, 1)
    y = np.bincount(own.ravel(), ys.ravel(), count) / np.maximum(area, 1)
    return own, count, x.astype(np.float32), y.astype(np.float32), np.sqrt(area / np.pi)


def harder(linear, label, rng):
    """Makes stones harder to tell: what is on them looks like borders, what is between them does not."""
    size = label.shape[0]
    own, count, x, y, radius = stones_of(label)
    ys, xs = np.mgrid[:size, :size].astype(np.float32)
    along, across = xs - x[own], ys - y[own]

    def chosen(share):
        """Some of the stones, never what is between them."""
        some = rng.random(count) < share
        some[0] = False
        return some

    def distance():
        """Of every pixel from a random line across its stone, pixels."""
        angle = rng.uniform(0, 2 * np.pi, count).astype(np.float32)
        away = (rng.uniform(-0.6, 0.6, count) * radius).astype(np.float32)
        return np.cos(angle)[own] * along + np.sin(angle)[own] * across - away[own]

    def bright(logarithm):
        return np.exp(logarithm).astype(np.float32)[..., None]

    if rng.random() < 0.4:
        # Fines that are brighter or darker than the rock, up to what a sensor cannot tell any more.
        linear = linear * bright(np.where(own == 0, rng.uniform(-1.3, 1.8), 0))
    if rng.random() < 0.5:
        spread = rng.uniform(0, 0.5)
        tones = rng.normal(0, spread, count)
        tones[0] = 0
        linear = linear * bright(tones[own])
    # Faces of one stone, one lit and one not.
    for _ in range(int(rng.integers(0, 3))):
        steps = np.where(chosen(rng.uniform(0.1, 0.9)), rng.normal(0, rng.uniform(0.1, 0.7), count), 0)
        linear = linear * bright(np.where(distance() > 0, steps[own], 0))
    # Joints and cracks, dark or filled.
    for _ in range(int(rng.integers(0, 3))):
        depths = np.where(chosen(rng.uniform(0.05, 0.5)), rng.normal(-0.5, 0.6, count), 0)
        width = rng.uniform(0.5, 1.6)
        bent = distance() + 0.12 * radius[own] * slow_noise(rng, int(rng.integers(6, 30)), size)[..., 0]
        linear = linear * bright(np.exp(-(bent / width) ** 2) * depths[own])
    if rng.random() < 0.25:
        # Bedding.
        waves = rng.uniform(2, 9, count)
        depths = np.where(chosen(0.6), rng.uniform(0, 0.35, count), 0)
        linear = linear * bright(np.sin(distance() * (2 * np.pi / waves)[own]) * depths[own])
    # Texture of everything, fine to coarse.
    for _ in range(int(rng.integers(0, 3))):
        cells = int(size / 2 ** rng.uniform(0.5, 5))
        linear = linear * bright(rng.uniform(0, 0.45) * slow_noise(rng, max(cells, 4), size)[..., 0])
    if rng.random() < 0.35:
        # Mud or dust of one colour in patches, over stones and what is between them.
        colour = linear.mean((0, 1)) * np.exp(rng.normal(0, 0.15, 3)) * np.exp(rng.uniform(-0.5, 0.6))
        edge = slow_noise(rng, int(rng.integers(3, 20)), size) * 2 + rng.uniform(-1.5, 0.8)
        cover = rng.uniform(0.4, 0.9) / (1 + np.exp(-edge * rng.uniform(2, 12)))
        relief = linear.mean(2, keepdims=True)
        relief = relief / (relief.mean() + 1e-3)
        linear = linear * (1 - cover) + cover * colour * relief ** rng.uniform(0.2, 0.9)
    if rng.random() < 0.2:
        # Crumbs on everything.
        crumbs = slow_noise(rng, int(size / rng.uniform(2, 6)), size)
        least = rng.uniform(0.6, 1.1)
        linear = linear * bright(np.where(crumbs[..., 0] > least, rng.normal(0, 0.6), 0))
    return linear


def patch(pairs, rng, size=SIDE, hard=0.75):
    """A random part of a random photo as a camera might have taken it, and its labels."""
    photo, label = pairs[rng.integers(len(pairs))]
    zoom = 2 ** rng.uniform(-1.0, 1.4)
    side = min(int(round(size / zoom)), photo.shape[0])
    y, x = (rng.integers(0, photo.shape[0] - side + 1) for _ in range(2))
    box = (x, y, x + side, y + side)
    how = Image.BOX if zoom < 1 else Image.BICUBIC
    image = np.asarray(Image.fromarray(photo).resize((size, size), how, box)).astype(np.float32) / 255
    at = (np.arange(size) + 0.5) * side / size
    at = at.astype(int)
    label = label[y:y + side, x:x + side][at[:, None], at[None, :]]
    turn, flip = rng.integers(4), rng.integers(2)
    image, label = np.rot90(image, turn), np.rot90(label, turn)
    if flip:
        image, label = image[:, ::-1], label[:, ::-1]
    image = np.ascontiguousarray(image)
    # Light.
    linear = image ** 2.2
    if rng.random() < hard:
        linear = harder(linear, label, rng)
    linear = linear * np.exp(rng.uniform(0, 0.5) * slow_noise(rng, 4, size))
    if rng.random() < 0.25:
        # Something casts a shadow that is none of the pile's.
        edge = slow_noise(rng, int(rng.integers(3, 6)), size) * 3 + rng.uniform(-1, 1)
        linear = linear * (1 - rng.uniform(0.3, 0.8) / (1 + np.exp(-np.clip(edge * rng.uniform(4, 40), -30, 30))))
    if rng.random() < 0.3:
        # Dust or mist.
        veil = rng.uniform(0, 0.35) * (1 + 0.5 * slow_noise(rng, 3, size))
        linear = linear * (1 - veil) + veil * rng.uniform(0.2, 0.7)
    if rng.random() < 0.15:
        # The shadow of something straight.
        angle, away = rng.uniform(0, 2 * np.pi), rng.uniform(-0.3, 0.3) * size
        ys, xs = np.mgrid[:size, :size].astype(np.float32) - size / 2
        beyond = np.cos(angle) * xs + np.sin(angle) * ys - away
        linear = linear * (1 - rng.uniform(0.3, 0.85) * np.clip(beyond / rng.uniform(0.7, 4), 0, 1))[..., None]
    gains = np.exp(rng.normal(0, 0.12, 3)).astype(np.float32) * np.exp(rng.uniform(-0.6, 0.6))
    image = np.clip(linear * gains, 0, 1) ** (1 / rng.uniform(1.6, 3.0))
    if rng.random() < 0.15:
        # Evened as a camera of a tunnel does: each place over what is around it.
        around = blurred(image.mean(2, keepdims=True), gauss(rng.uniform(5, 25)))
        image = np.clip(image * (rng.uniform(0.35, 0.65) / (around + 0.05)) ** rng.uniform(0.3, 1.0), 0, 1)
    if rng.random() < 0.3:
        image = np.repeat(image.mean(2, keepdims=True), 3, 2)
    elif rng.random() < 0.5:
        gray = image.mean(2, keepdims=True)
        image = gray + (image - gray) * rng.uniform(0.3, 2.2)
    # Lens, motion, sensor.
    if rng.random() < 0.6:
        image = blurred(image, gauss(rng.uniform(0.3, 1.5)))
    if rng.random() < 0.12:
        r = int(rng.integers(1, 4))
        kernel = np.zeros((2 * r + 1, 2 * r + 1))
        angle = rng.uniform(0, np.pi)
        for s in np.linspace(-r, r, 4 * r + 1):
            kernel[int(round(r + s * np.sin(angle))), int(round(r + s * np.cos(angle)))] += 1
        image = blurred(image, kernel / kernel.sum())
    if rng.random() < 0.3:
        image = image + rng.uniform(0.3, 3.0) * (image - blurred(image, gauss(rng.uniform(0.7, 2.0))))
    noise = rng.normal(0, rng.uniform(0, 0.06), image.shape[:2] + ((3,) if rng.random() < 0.5 else (1,)))
    image = np.clip(image + noise, 0, 1)
    if rng.random() < 0.6:
        file = io.BytesIO()
        Image.fromarray((image * 255).astype(np.uint8)).save(file, "JPEG", quality=int(rng.integers(35, 95)))
        image = np.asarray(Image.open(file)).astype(np.float32) / 255
    return image.astype(np.float32), label


def normalised(image):
    return ((image - image.mean()) / (image.std() + 1e-3)).transpose(2, 0, 1).astype(np.float32)


def targets(label):
    """Border, rock and middle of a label image."""
    label = np.ascontiguousarray(label)
    counts = np.bincount(label.ravel())
    label = np.where(counts[label] < LEAST_PIXELS, 0, label)
    border = np.zeros(label.shape, bool)
    for axis in (0, 1):
        differs = np.diff(label, axis=axis) != 0
        a, b = [slice(None)] * 2, [slice(None)] * 2
        a[axis], b[axis] = slice(0, -1), slice(1, None)
        border[tuple(a)] |= differs
        border[tuple(b)] |= differs
    rock = label > 0
    # How far each pixel lies from the border, a ring at a time, over the most of its fragment.
    far = np.zeros(label.shape, np.float32)
    left = torch.from_numpy((rock & ~border).astype(np.float32))[None, None]
    ring = 0
    while left.any() and ring < 80:
        far += left[0, 0].numpy()
        # A square and a diamond by turns: nearly a circle.
        if ring % 2:
            left = -F.max_pool2d(-F.pad(left, (1, 1, 1, 1)), 3, 1)
        else:
            out = F.pad(left, (1, 1, 1, 1))
            left = torch.stack([out[..., 1:-1, 1:-1], out[..., :-2, 1:-1], out[..., 2:, 1:-1], out[..., 1:-1, :-2], out[..., 1:-1, 2:]]).amin(0)
        ring += 1
    most = np.zeros(counts.size, np.float32)
    np.maximum.at(most, label.ravel(), far.ravel())
    middle = np.where(rock, far / np.maximum(most[label], 1), 0).astype(np.float32)
    return border.astype(np.float32), rock.astype(np.float32), middle


class Patches(torch.utils.data.IterableDataset):
    def __init__(self, pairs, seed, steps, hard):
        self.pairs, self.seed, self.steps, self.hard = pairs, seed, steps, hard

    def __iter__(self):
        for step in range(self.steps):
            rng = np.random.default_rng([self.seed, step])
            many = [patch(self.pairs, rng, hard=self.hard) for _ in range(BATCH)]
            many = [(normalised(image), *targets(label)) for image, label in many]
            image, border, rock, middle = (torch.from_numpy(np.stack(part)) for part in zip(*many))
            yield image, torch.stack([border, rock, middle], 1)


def write_patches(pairs, seed, count, folder, hard):
    """Patches as photos with labels, for the training of the score."""
    for kind in ("photos", "labels"):
        (folder / kind).mkdir(parents=True, exist_ok=True)
    for number in range(count):
        image, label = patch(pairs, np.random.default_rng([seed, number]), 384, hard)
        counts = np.bincount(label.ravel())
        label = np.where(counts[label] < LEAST_PIXELS, 0, label).astype(np.uint16)
        Image.fromarray((image * 255).round().astype(np.uint8)).save(folder / "photos" / f"{number:05}.png")
        Image.fromarray(label).save(folder / "labels" / f"{number:05}.png")


def loss_of(found, wanted):
    weight = torch.ones_like(wanted)
    # Borders are few.
    weight[:, 0] += 2.0 * wanted[:, 0]
    return F.binary_cross_entropy_with_logits(found, wanted, weight)


def begin_from(net, path, images):
    """The weights of a file that `write_onnx` wrote. Its normalisation lies within its weights; here each gets one
    that changes nothing on these images."""
    import onnx
    from onnx import numpy_helper

    parts = {part.name: torch.from_numpy(numpy_helper.to_array(part).copy()) for part in onnx.load(path).graph.initializer}
    convolutions, hooks = [], []
    for block in list(net.down) + list(net.up):
        layers = list(block.layers)
        convolutions += list(zip(layers[0::3], layers[1::3]))

    def unchanged(offset):
        def hook(norm, inputs):
            seen = inputs[0]
            mean, variance = seen.mean((0, 2, 3)), seen.var((0, 2, 3), unbiased=False)
            norm.running_mean.copy_(mean)
            norm.running_var.copy_(variance)
            norm.weight.data.copy_(torch.sqrt(variance + norm.eps))
            norm.bias.data.copy_(offset + mean)
        return hook

    for number, (conv, norm) in enumerate(convolutions):
        conv.weight.data.copy_(parts[f"w{number}"])
        hooks.append(norm.register_forward_pre_hook(unchanged(parts[f"b{number}"])))
    net.head.weight.data.copy_(parts[f"w{len(convolutions)}"])
    net.head.bias.data.copy_(parts[f"b{len(convolutions)}"])
    net.eval()
    with torch.no_grad():
        net(images)
    for hook in hooks:
        hook.remove()


def folded(net):
    """Weights and biases of every convolution in order, its batch normalisation within."""
    convolutions = []
    for block in list(net.down) + list(net.up):
        layers = list(block.layers)
        for conv, norm in zip(layers[0::3], layers[1::3]):
            gain = norm.weight / torch.sqrt(norm.running_var + norm.eps)
            convolutions.append((conv.weight * gain[:, None, None, None], norm.bias - norm.running_mean * gain))
    convolutions.append((net.head.weight, net.head.bias))
    return [(w.detach().numpy().astype(np.float32), b.detach().numpy().astype(np.float32)) for w, b in convolutions]


def write_onnx(net, path):
    """The network as ONNX, opset 13: any runtime reads it."""
    import onnx
    from onnx import TensorProto, helper, numpy_helper

    nodes, weights = [], []
    convolutions = iter(folded(net))

    def conv(x, relu=True):
        w, b = next(convolutions)
        n = len(weights) // 2
        weights.append(numpy_helper.from_array(w, f"w{n}"))
        weights.append(numpy_helper.from_array(b, f"b{n}"))
        pad = w.shape[2] // 2
        nodes.append(helper.make_node("Conv", [x, f"w{n}", f"b{n}"], [f"c{n}"], pads=[pad] * 4, kernel_shape=list(w.shape[2:])))
        if not relu:
            return f"c{n}"
        nodes.append(helper.make_node("Relu", [f"c{n}"], [f"r{n}"]))
        return f"r{n}"

    x, seen = "photo", []
    for level in range(len(CHANNELS)):
        if level:
            nodes.append(helper.make_node("MaxPool", [x], [f"p{level}"], kernel_shape=[2, 2], strides=[2, 2]))
            x = f"p{level}"
        x = conv(conv(x))
        seen.append(x)
    weights.append(numpy_helper.from_array(np.array([1, 1, 2, 2], np.float32), "twice"))
    for level in reversed(range(len(CHANNELS) - 1)):
        nodes.append(helper.make_node("Resize", [x, "", "twice"], [f"u{level}"], mode="nearest", coordinate_transformation_mode="asymmetric", nearest_mode="floor"))
        nodes.append(helper.make_node("Concat", [seen[level], f"u{level}"], [f"j{level}"], axis=1))
        x = conv(conv(f"j{level}"))
    x = conv(x, relu=False)
    nodes.append(helper.make_node("Sigmoid", [x], ["found"]))
    graph = helper.make_graph(
        nodes, "fragments",
        [helper.make_tensor_value_info("photo", TensorProto.FLOAT, [1, 3, "height", "width"])],
        [helper.make_tensor_value_info("found", TensorProto.FLOAT, [1, 3, "height", "width"])],
        weights)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)], producer_name="fragscale")
    model.ir_version = 8
    onnx.checker.check_model(model)
    onnx.save(model, path)


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("train", help="folders of photos and labels, apart by commas")
    ask.add_argument("valid")
    ask.add_argument("--to", default=".")
    ask.add_argument("--steps", type=int, default=1500)
    ask.add_argument("--seed", type=int, default=1)
    ask.add_argument("--from", dest="before", help="goes on from these weights")
    ask.add_argument("--rate", type=float, default=4e-3, help="the most that a step changes")
    ask.add_argument("--threads", type=int)
    ask.add_argument("--patches", type=int, help="no training: write so many patches of TRAIN to the folder")
    ask.add_argument("--hard", type=float, default=0.75, help="the share of patches that are made harder")
    ask = ask.parse_args()
    if ask.patches:
        return write_patches(load(ask.train), ask.seed + 7, ask.patches, pathlib.Path(ask.to), ask.hard)
    torch.manual_seed(ask.seed)
    if ask.threads:
        torch.set_num_threads(ask.threads)
    train, valid = load(ask.train), load(ask.valid)
    # Half as long as with the channels apart, on a processor.
    net = Net().to(memory_format=torch.channels_last)
    count = sum(p.numel() for p in net.parameters())
    to = pathlib.Path(ask.to)
    to.mkdir(parents=True, exist_ok=True)
    log = open(to / "training.log", "w")

    def say(text):
        print(text, flush=True)
        print(text, file=log, flush=True)

    say(f"{len(train)} photos, {len(valid)} to look at; {count} weights; seed {ask.seed}, {ask.steps} steps of {BATCH} patches of {SIDE} pixels")
    held = list(Patches(valid, ask.seed + 1000, 8, ask.hard))
    if ask.before:
        begin_from(net, ask.before, torch.cat([image for image, _ in Patches(train, ask.seed + 2000, 6, ask.hard)]))
        with torch.no_grad():
            unseen = sum(loss_of(net(i), w).item() for i, w in held) / len(held)
        say(f"from {pathlib.Path(ask.before).name}: on other piles {unseen:.4f}")
    optimiser = torch.optim.AdamW(net.parameters(), lr=ask.rate, weight_decay=1e-4)
    # Then always the same: any step is a good one to stop at, because what is written is the mean of weights.
    schedule = torch.optim.lr_scheduler.LambdaLR(optimiser, lambda step: min(1.0, (step + 1) / 60))
    average = torch.optim.swa_utils.AveragedModel(net, multi_avg_fn=torch.optim.swa_utils.get_ema_multi_avg_fn(0.99), use_buffers=True)
    start, mean = time.time(), None
    for step, (image, wanted) in enumerate(Patches(train, ask.seed, ask.steps, ask.hard)):
        net.train()
        optimiser.zero_grad()
        loss = loss_of(net(image.to(memory_format=torch.channels_last)), wanted)
        loss.backward()
        optimiser.step()
        schedule.step()
        average.update_parameters(net)
        mean = loss.item() if mean is None else 0.98 * mean + 0.02 * loss.item()
        if step % 100 == 99:
            average.eval()
            with torch.no_grad():
                unseen = sum(loss_of(average(i), w).item() for i, w in held) / len(held)
            say(f"step {step + 1}: loss {mean:.4f}, on other piles {unseen:.4f}, {(time.time() - start) / 60:.1f} min")
            write_onnx(average.module, to / f"fragments_{step + 1}.onnx")
    write_onnx(average.module.eval(), to / "fragments.onnx")


if __name__ == "__main__":
    main()
