"""Trains the network that finds the fragments of a photo, on simulated photos alone.

    cargo run --release -p fragscale-sample --example training_photos -- TRAIN 1 150 512
    cargo run --release -p fragscale-sample --example training_photos -- VALID 2 8 512
    python3 piles.py MORE 11 900                                 # piles of more kinds
    python3 train.py TRAIN,MORE VALID --to OUT [--minutes 9 --batch 64] [--from fragments.onnx]
    python3 train.py TRAIN,MORE VALID --to PATCHES --patches 300     # for train_score.py

Needs torch, numpy, scipy, scikit-image, pillow and onnx; a card with minutes, or two cores and hours. No photo of the
world is used: the labels of simulated photos are exact, and their licence is ours. What happens to a photo is drawn
anew for every step (patches.py). Everything follows from the seed and the number of steps; on another machine the weights
differ in their last digits, and where a time ends the training in more.

The network is a U-Net of six levels. In: RGB, less the photo's mean, over its standard deviation (both over all
pixels and channels). Out, each between 0 and 1:

- border: a pixel beside another fragment or what is none;
- rock: a fragment rather than fines, floor, anything else;
- middle: 0 at a fragment's border, 1 where its largest inscribed circle has its centre;
- size: the diameter of the circle with the area of the fragment that the pixel lies on, as a power of two, a tenth of it;
- right, down: the way to that fragment's centroid in such diameters, half of it more than a half.

The last three are votes: of a region that is one whole fragment, all pixels vote for its size and its centroid; those
of a part or of two joined do not (as in Neven et al. 2019; here the tree proposes the regions).
"""
import argparse
import pathlib
import time

import numpy as np
import torch
import torch.nn as nn
import torch.nn.functional as F
from PIL import Image

from patches import SIZES, Photos, normalised, patches, targets

SIDE = 256
# Of each level.
CHANNELS = "12,24,40,64,96,144"
# Border, rock, middle, size, right, down.
KINDS = 6


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
    def __init__(self, channels):
        super().__init__()
        c = self.channels = channels
        self.down = nn.ModuleList([Block(before, after) for before, after in zip([3] + c, c)])
        self.up = nn.ModuleList([Block(c[i] + c[i + 1], c[i]) for i in reversed(range(len(c) - 1))])
        self.head = nn.Conv2d(c[0], KINDS, 1)

    def forward(self, x):
        seen = []
        for level, block in enumerate(self.down):
            x = block(F.max_pool2d(x, 2) if level else x)
            seen.append(x)
        for block, beside in zip(self.up, reversed(seen[:-1])):
            x = F.interpolate(x, scale_factor=2.0, mode="nearest")
            x = block(torch.cat([beside, x], 1))
        return self.head(x)


def generator_of(photos, seed, step):
    return torch.Generator(photos.device).manual_seed(seed * 1_000_003 + step)


def drawn(photos, seed, step, many, hard):
    """A batch: what the network sees and what it is to say."""
    image, *of_stones = patches(photos, generator_of(photos, seed, step), many, SIDE, hard)
    return normalised(image), targets(*of_stones)


def loss_of(found, wanted):
    """Of the first three the cross entropy; of the votes how far they are off, on fragments."""
    found = found.float()
    weight = torch.ones_like(wanted[:, :3])
    # Borders are few.
    weight[:, 0] += 2.0 * wanted[:, 0]
    rock = wanted[:, 1:2]
    off = rock * (torch.sigmoid(found[:, 3:]) - wanted[:, 3:]).abs()
    size, way = off.split([1, 2], 1)
    stones = rock.sum() + 1.0
    votes = 0.12 * SIZES * size.sum() / stones + 1.2 * way.sum() / stones
    return F.binary_cross_entropy_with_logits(found[:, :3], wanted[:, :3], weight) + votes


def write_patches(photos, seed, count, folder, hard):
    """Patches as photos with labels, for the training of the score."""
    for kind in ("photos", "labels"):
        (folder / kind).mkdir(parents=True, exist_ok=True)
    for number in range(count):
        image, own, *_ = patches(photos, generator_of(photos, seed, number), 1, 384, hard)
        image = (image[0] * 255).round().byte().permute(1, 2, 0).cpu().numpy()
        Image.fromarray(image).save(folder / "photos" / f"{number:05}.png")
        Image.fromarray(own[0, 0].cpu().numpy().astype(np.uint16)).save(folder / "labels" / f"{number:05}.png")


def begin_from(net, path, images):
    """The weights of a file that `write_onnx` wrote. Its normalisation lies within its weights; here each gets one
    that changes nothing on these images."""
    import onnx
    from onnx import numpy_helper

    parts = {part.name: torch.from_numpy(numpy_helper.to_array(part).copy()).to(images.device) for part in onnx.load(path).graph.initializer}
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
    return [(w.detach().cpu().numpy().astype(np.float32), b.detach().cpu().numpy().astype(np.float32)) for w, b in convolutions]


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
    for level in range(len(net.channels)):
        if level:
            nodes.append(helper.make_node("MaxPool", [x], [f"p{level}"], kernel_shape=[2, 2], strides=[2, 2]))
            x = f"p{level}"
        x = conv(conv(x))
        seen.append(x)
    weights.append(numpy_helper.from_array(np.array([1, 1, 2, 2], np.float32), "twice"))
    for level in reversed(range(len(net.channels) - 1)):
        nodes.append(helper.make_node("Resize", [x, "", "twice"], [f"u{level}"], mode="nearest", coordinate_transformation_mode="asymmetric", nearest_mode="floor"))
        nodes.append(helper.make_node("Concat", [seen[level], f"u{level}"], [f"j{level}"], axis=1))
        x = conv(conv(f"j{level}"))
    x = conv(x, relu=False)
    nodes.append(helper.make_node("Sigmoid", [x], ["found"]))
    graph = helper.make_graph(
        nodes, "fragments",
        [helper.make_tensor_value_info("photo", TensorProto.FLOAT, [1, 3, "height", "width"])],
        [helper.make_tensor_value_info("found", TensorProto.FLOAT, [1, KINDS, "height", "width"])],
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
    ask.add_argument("--steps", type=int, help="1500 unless minutes are given")
    ask.add_argument("--minutes", type=float, help="ends after so many minutes, however many steps that are")
    ask.add_argument("--batch", type=int, default=6)
    ask.add_argument("--seed", type=int, default=1)
    ask.add_argument("--channels", default=CHANNELS)
    ask.add_argument("--from", dest="before", help="goes on from these weights")
    ask.add_argument("--rate", type=float, default=4e-3, help="the most that a step changes")
    ask.add_argument("--patches", type=int, help="no training: write so many patches of TRAIN to the folder")
    ask.add_argument("--hard", type=float, default=0.75, help="the share of patches that are made harder")
    ask = ask.parse_args()
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    to = pathlib.Path(ask.to)
    if ask.patches:
        return write_patches(Photos(ask.train, device), ask.seed + 7, ask.patches, to, ask.hard)
    steps = ask.steps or (10**9 if ask.minutes else 1500)
    torch.manual_seed(ask.seed)
    torch.backends.cudnn.benchmark = True
    to.mkdir(parents=True, exist_ok=True)
    log = open(to / "training.log", "w")

    def say(text):
        print(text, flush=True)
        print(text, file=log, flush=True)

    start = time.time()
    train, valid = Photos(ask.train, device), Photos(ask.valid, device)
    # Half as long as with the channels apart, on a processor.
    net = Net([int(many) for many in ask.channels.split(",")]).to(device, memory_format=torch.channels_last)
    count = sum(p.numel() for p in net.parameters())
    say(f"{len(train)} photos, {len(valid)} to look at, read in {time.time() - start:.0f} s; {count} weights; seed {ask.seed}, patches of {SIDE} pixels, {ask.batch} a step; {device.type}, torch {torch.__version__}")
    held = [drawn(valid, ask.seed + 1000, step, 6, ask.hard) for step in range(16)]

    def unseen(net):
        net.eval()
        with torch.no_grad():
            losses = [loss_of(net(image), wanted).item() for image, wanted in held]
        return sum(losses) / len(losses)

    if ask.before:
        begin_from(net, ask.before, torch.cat([drawn(train, ask.seed + 2000, step, 6, ask.hard)[0] for step in range(6)]))
        say(f"from {pathlib.Path(ask.before).name}: on other piles {unseen(net):.4f}")
    optimiser = torch.optim.AdamW(net.parameters(), lr=ask.rate, weight_decay=1e-4)
    # What is written is a mean of weights that forgets within a hundred steps, or five hundred where there are many.
    average = torch.optim.swa_utils.AveragedModel(net, multi_avg_fn=torch.optim.swa_utils.get_ema_multi_avg_fn(0.99 if steps < 5000 else 0.998), use_buffers=True)
    start, mean, step, done = time.time(), None, 0, 0.0
    while done < 1.0:
        # Up at once, then down along a cosine.
        rate = ask.rate * min(1.0, (step + 1) / 60) * (0.51 + 0.49 * np.cos(np.pi * done))
        for group in optimiser.param_groups:
            group["lr"] = rate
        image, wanted = drawn(train, ask.seed, step, ask.batch, ask.hard)
        net.train()
        optimiser.zero_grad()
        with torch.autocast(device.type, torch.bfloat16, enabled=device.type == "cuda"):
            found = net(image.to(memory_format=torch.channels_last))
        loss = loss_of(found, wanted)
        loss.backward()
        optimiser.step()
        average.update_parameters(net)
        step += 1
        done = step / steps
        if ask.minutes:
            done = max(done, (time.time() - start) / 60 / ask.minutes)
        if step % (100 if steps < 5000 else 500) == 0:
            mean = loss.item() if mean is None else 0.7 * mean + 0.3 * loss.item()
            say(f"step {step}: loss {mean:.4f}, on other piles {unseen(average):.4f}, {(time.time() - start) / 60:.1f} min")
            write_onnx(average.module, to / "going_on.onnx")
    say(f"step {step}, the last: on other piles {unseen(average):.4f}, {(time.time() - start) / 60:.1f} min")
    write_onnx(average.module.eval(), to / "fragments.onnx")


if __name__ == "__main__":
    main()
