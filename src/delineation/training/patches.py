"""Patches of simulated photos as a camera might have taken them, many at a time, on a processor or a card.

What happens to a pile, and what lens, sensor and file do to its photo, is drawn anew for every patch: broken faces,
joints, bedding, mud and dust over stones and what is between them, fines brighter or darker than rock, hard shadows;
zoom, turn, light, fog, colour or grey, blur, motion, sharpening, evened contrast, noise, JPEG. Of each pixel is asked
what train.py's network is to say of it.

All of it is arithmetic on whole batches [patch, channel, row, column]: an effect that a patch does not have is there
with a strength of 0. Everything follows from the generator; on another kind of device the numbers differ.
"""
import math
import multiprocessing
import pathlib

import numpy as np
import torch
import torch.nn.functional as F
from PIL import Image
from scipy import ndimage
from skimage import measure

# Smaller fragments are fines to a photo, pixels.
LEAST_PIXELS = 16
# A part of a fragment that something else cuts off is a fragment of its own, or too small to be one.
LEAST_PART = 12
# What the network's vote for a size of 1 is, as a power of two: pixels across.
SIZES = 10.0
# Stones of a photo beyond so many share their random numbers.
STONES = 4096
# The cells of the random lattice that slow noise is cut from.
CELLS = 200


def asked(pair):
    """A photo, the number of each pixel's stone (0 none), and of each pixel: how far within its stone (0 to 1), the
    stone's diameter as a power of two, and the way to its middle in diameters, right and down."""
    photo, label = pair
    image = np.array(Image.open(photo).convert("RGB")).transpose(2, 0, 1)
    own = measure.label(np.array(Image.open(label)).astype(np.int32), connectivity=1, background=0)
    count = np.bincount(own.ravel())
    numbers, own = np.unique(np.where(count[own] < LEAST_PART, 0, own), return_inverse=True)
    # A photo that shows stones alone has no 0.
    own = own.reshape(image.shape[1:]) + int(numbers[0] != 0)
    differs = np.zeros(own.shape, bool)
    for axis in (0, 1):
        step = np.diff(own, axis=axis) != 0
        a, b = [slice(None)] * 2, [slice(None)] * 2
        a[axis], b[axis] = slice(0, -1), slice(1, None)
        differs[tuple(a)] |= step
        differs[tuple(b)] |= step
    rock = own > 0
    far = ndimage.distance_transform_edt(rock & ~differs)
    stones = int(own.max()) + 1
    most = np.zeros(stones)
    np.maximum.at(most, own.ravel(), far.ravel())
    area = np.maximum(np.bincount(own.ravel(), minlength=stones), 1)
    ys, xs = np.mgrid[:own.shape[0], :own.shape[1]]
    across = np.sqrt(4 / np.pi * area)
    middle = [np.bincount(own.ravel(), at.ravel(), stones) / area for at in (xs, ys)]
    to = [np.where(rock, (middle[k][own] - at) / across[own], 0) for k, at in enumerate((xs, ys))]
    maps = np.stack([np.where(rock, far / np.maximum(most[own], 1), 0), np.where(rock, np.log2(across[own]), 0), *to])
    return image, own.astype(np.int16), maps.astype(np.float16)


class Photos:
    """Square photos of one size, with what is asked of their pixels, on a device."""

    def __init__(self, folders, device):
        pairs = []
        for folder in map(pathlib.Path, folders.split(",")):
            pairs += [(photo, folder / "labels" / f"{photo.stem}.png") for photo in sorted((folder / "photos").iterdir())]
        with multiprocessing.Pool() as pool:
            parts = zip(*pool.map(asked, pairs, chunksize=4))
        self.image, self.own, self.maps = (torch.from_numpy(np.stack(part)).to(device) for part in parts)
        self.device = device

    def __len__(self):
        return len(self.image)


class Draw:
    """Random numbers for a batch of patches: one a patch, unless a shape is given."""

    def __init__(self, generator, many, device):
        self.generator, self.many, self.device = generator, many, device

    def unit(self, *shape):
        return torch.rand(self.many, *(shape or (1, 1, 1)), generator=self.generator, device=self.device)

    def uniform(self, least, most, *shape):
        return least + (most - least) * self.unit(*shape)

    def normal(self, *shape):
        return torch.randn(self.many, *(shape or (1, 1, 1)), generator=self.generator, device=self.device)

    def happens(self, chance, *shape):
        return (self.unit(*shape) < chance).float()

    def up_to(self, most):
        """A whole number from 0 to the most."""
        return (self.unit() * (most + 1)).floor()

    def slow_noise(self, cells, size):
        """Between about -1 and 1, so many cells along a side."""
        lattice = self.uniform(-1, 1, 1, CELLS, CELLS)
        at = (torch.arange(size, device=self.device) + 0.5) / size
        at = 2 * (1 + at[None] * cells.reshape(-1, 1)) / (CELLS - 1) - 1
        grid = torch.stack([at[:, None, :].expand(-1, size, -1), at[:, :, None].expand(-1, -1, size)], 3)
        return F.grid_sample(lattice, grid, "bicubic", "reflection", align_corners=True)


def each_by_its_kernel(image, kernel):
    """Every patch by a kernel of its own, [patch, rows, columns] of odd sides."""
    many, channels, height, width = image.shape
    rows, columns = kernel.shape[1:]
    padded = F.pad(image, (columns // 2,) * 2 + (rows // 2,) * 2, mode="replicate")
    kernel = kernel.repeat_interleave(channels, 0)[:, None]
    return F.conv2d(padded.reshape(1, many * channels, *padded.shape[2:]), kernel, groups=many * channels).reshape(many, channels, height, width)


def blurred(image, sigma, reach):
    """By a Gauss of a width of its own for each patch, cut off at `reach` pixels."""
    away = torch.arange(-reach, reach + 1, device=image.device, dtype=torch.float32)
    kernel = torch.exp(-0.5 * (away / sigma.reshape(-1, 1).clamp(min=0.05)) ** 2)
    kernel = kernel / kernel.sum(1, keepdim=True)
    return each_by_its_kernel(each_by_its_kernel(image, kernel[:, None, :]), kernel[:, :, None])


def harder(linear, own, across, to_middle, draw):
    """Makes stones harder to tell: what is on them looks like borders, what is between them does not."""
    size = linear.shape[-1]
    rock = (own > 0).float()
    number = torch.where(own > 0, 1 + (own - 1) % (STONES - 1), 0)
    flat = number.reshape(number.shape[0], -1)
    radius = 0.5 * across
    along, aside = (-to_middle * across).split(1, 1)

    def of_stones(values):
        return rock * values.gather(1, flat).reshape(number.shape)

    def distance():
        """Of every pixel from a random line across its stone, pixels."""
        angle = draw.uniform(0, 2 * math.pi, STONES)
        away = draw.uniform(-0.6, 0.6, STONES)
        return of_stones(angle.cos()) * along + of_stones(angle.sin()) * aside - of_stones(away) * radius

    def some(least, most):
        return (draw.unit(STONES) < draw.uniform(least, most, 1)).float()

    def times(linear, logarithm):
        return linear * torch.exp(logarithm)

    # Fines that are brighter or darker than the rock, up to what a sensor cannot tell any more.
    linear = times(linear, (1 - rock) * draw.happens(0.4) * draw.uniform(-1.3, 1.8))
    linear = times(linear, of_stones(draw.normal(STONES) * draw.uniform(0, 0.5, 1) * draw.happens(0.5, 1)))
    # Faces of one stone, one lit and one not; the edge between them is not straight.
    faces = draw.up_to(4)
    for number_of_face in range(4):
        step = some(0.1, 0.9) * draw.normal(STONES) * draw.uniform(0.1, 0.7, 1)
        bent = distance() + radius * draw.uniform(0, 0.25) * draw.slow_noise(draw.uniform(5, 40), size)
        linear = times(linear, (faces > number_of_face).float() * of_stones(step) * torch.sigmoid(bent / draw.uniform(0.2, 2.5)))
    # Joints and cracks, dark or filled.
    joints = draw.up_to(2)
    for number_of_joint in range(2):
        depth = some(0.05, 0.5) * (0.6 * draw.normal(STONES) - 0.5)
        bent = distance() + 0.12 * radius * draw.slow_noise(draw.uniform(6, 30), size)
        linear = times(linear, (joints > number_of_joint).float() * torch.exp(-(bent / draw.uniform(0.5, 1.6)) ** 2) * of_stones(depth))
    # Bedding.
    waves = 2 * math.pi / draw.uniform(2, 9, STONES)
    depth = draw.happens(0.25, 1) * some(0.6, 0.6) * draw.uniform(0, 0.35, STONES)
    linear = times(linear, torch.sin(distance() * of_stones(waves)) * of_stones(depth))
    # Texture of everything, fine to coarse.
    textures = draw.up_to(2)
    for number_of_texture in range(2):
        cells = (size / 2 ** draw.uniform(0.5, 5)).clamp(4, CELLS - 4)
        linear = times(linear, (textures > number_of_texture).float() * draw.uniform(0, 0.45) * draw.slow_noise(cells, size))
    # Mud or dust of one colour in patches, over stones and what is between them.
    colour = linear.mean((2, 3), keepdim=True) * torch.exp(0.15 * draw.normal(3, 1, 1)) * torch.exp(draw.uniform(-0.5, 0.6))
    edge = 2 * draw.slow_noise(draw.uniform(3, 20), size) + draw.uniform(-1.5, 0.8)
    cover = draw.happens(0.35) * draw.uniform(0.4, 0.9) * torch.sigmoid(edge * draw.uniform(2, 12))
    relief = linear.mean(1, keepdim=True)
    relief = (relief / (relief.mean((2, 3), keepdim=True) + 1e-3)).clamp(min=1e-4)
    linear = linear * (1 - cover) + cover * colour * relief ** draw.uniform(0.2, 0.9)
    # Crumbs on everything.
    crumbs = draw.slow_noise((size / draw.uniform(2, 6)).clamp(4, CELLS - 4), size)
    there = draw.happens(0.2) * (crumbs > draw.uniform(0.6, 1.1)).float()
    return times(linear, there * 0.6 * draw.normal())


def lit(linear, draw):
    """Under other light: uneven, in shadows of what is none of the pile, in mist."""
    size = linear.shape[-1]
    linear = linear * torch.exp(draw.uniform(0, 0.5) * draw.slow_noise(torch.full_like(draw.unit(), 4.0), size))
    edge = 3 * draw.slow_noise(draw.uniform(3, 6), size) + draw.uniform(-1, 1)
    linear = linear * (1 - draw.happens(0.25) * draw.uniform(0.3, 0.8) * torch.sigmoid(edge * draw.uniform(4, 40)))
    veil = draw.happens(0.3) * draw.uniform(0, 0.35) * (1 + 0.5 * draw.slow_noise(torch.full_like(draw.unit(), 3.0), size))
    linear = linear * (1 - veil) + veil * draw.uniform(0.2, 0.7)
    # The shadow of something straight.
    angle = draw.uniform(0, 2 * math.pi)
    at = torch.arange(size, device=linear.device, dtype=torch.float32) - size / 2
    beyond = angle.cos() * at[None, None, None, :] + angle.sin() * at[None, None, :, None] - draw.uniform(-0.3, 0.3) * size
    return linear * (1 - draw.happens(0.15) * draw.uniform(0.3, 0.85) * (beyond / draw.uniform(0.7, 4)).clamp(0, 1))


def taken(linear, draw):
    """What a camera makes of it: a picture from 0 to 1."""
    size = linear.shape[-1]
    gains = torch.exp(0.12 * draw.normal(3, 1, 1)) * torch.exp(draw.uniform(-0.6, 0.6))
    image = (linear * gains).clamp(1e-5, 1) ** (1 / draw.uniform(1.6, 3.0))
    # Evened as a camera of a tunnel does: each place over what is around it.
    coarse = F.avg_pool2d(image.mean(1, keepdim=True), 8)
    around = F.interpolate(blurred(coarse, draw.uniform(0.6, 3.1), 9), size=(size, size), mode="bilinear")
    evened = (image * (draw.uniform(0.35, 0.65) / (around + 0.05)) ** draw.uniform(0.3, 1.0)).clamp(0, 1)
    image = torch.where(draw.happens(0.15) > 0, evened, image)
    # Stretched until its darkest and brightest are cut off.
    steep = torch.where(draw.happens(0.2) > 0, draw.uniform(1.0, 2.5), 1.0)
    middle = image.mean((1, 2, 3), keepdim=True)
    image = (middle + steep * (image - middle)).clamp(0, 1)
    gray = image.mean(1, keepdim=True)
    colour = torch.where(draw.happens(0.5) > 0, draw.uniform(0.3, 2.2), 1.0) * (1 - draw.happens(0.3))
    image = gray + (image - gray) * colour
    # Lens, motion, sharpening, sensor.
    image = blurred(image, draw.happens(0.6) * draw.uniform(0.3, 1.5), 4)
    reach, angle = draw.happens(0.12) * draw.uniform(0.7, 3.4), draw.uniform(0, math.pi)
    at = torch.arange(-3, 4, device=image.device, dtype=torch.float32)
    x, y = at[None, None, :], at[None, :, None]
    reach, angle = reach.reshape(-1, 1, 1), angle.reshape(-1, 1, 1)
    along, aside = angle.cos() * x + angle.sin() * y, angle.cos() * y - angle.sin() * x
    kernel = torch.exp(-2 * aside ** 2) * (along.abs() <= reach + 0.01)
    still = ((x == 0) & (y == 0)).float().expand_as(kernel)
    kernel = torch.where(reach > 0, kernel, still)
    image = each_by_its_kernel(image, kernel / kernel.sum((1, 2), keepdim=True))
    image = image + draw.happens(0.3) * draw.uniform(0.3, 3.0) * (image - blurred(image, draw.uniform(0.7, 2.0), 5))
    one = draw.happens(0.5)
    noise = one * draw.normal(1, size, size) + (1 - one) * draw.normal(3, size, size)
    image = (image + draw.uniform(0, 0.06) * noise).clamp(0, 1)
    return torch.where(draw.happens(0.6) > 0, jpeg(image, draw.uniform(35, 95), draw.happens(0.7)), image)


# Annex K of ITU-T T.81.
LUMA = [16, 11, 10, 16, 24, 40, 51, 61, 12, 12, 14, 19, 26, 58, 60, 55, 14, 13, 16, 24, 40, 57, 69, 56, 14, 17, 22, 29, 51, 87, 80, 62,
        18, 22, 37, 56, 68, 109, 103, 77, 24, 35, 55, 64, 81, 104, 113, 92, 49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99]
CHROMA = [17, 18, 24, 47, 99, 99, 99, 99, 18, 21, 26, 66, 99, 99, 99, 99, 24, 26, 56, 99, 99, 99, 99, 99, 47, 66, 99, 99, 99, 99, 99, 99] + [99] * 32
TO_LUMA = [[0.299, 0.587, 0.114], [-0.168736, -0.331264, 0.5], [0.5, -0.418688, -0.081312]]


def jpeg(image, quality, halved):
    """As JPEG of that quality gives it back; where `halved`, colours of half the size."""
    device, (many, _, height, width) = image.device, image.shape
    to = torch.tensor(TO_LUMA, device=device)
    parts = torch.einsum("kc,nchw->nkhw", to, image) * 255
    less = F.interpolate(F.avg_pool2d(parts[:, 1:], 2), scale_factor=2.0, mode="nearest")
    parts = torch.cat([parts[:, :1] - 128, torch.where(halved > 0, less, parts[:, 1:])], 1)
    k = torch.arange(8, device=device, dtype=torch.float32)
    cosines = torch.cos((2 * k[None, :] + 1) * k[:, None] * math.pi / 16) * 0.5
    cosines[0] /= math.sqrt(2)
    scale = torch.where(quality < 50, 50 / quality, 2 - quality / 50).reshape(-1, 1, 1, 1, 1, 1)
    tables = torch.tensor([LUMA, CHROMA, CHROMA], device=device, dtype=torch.float32).reshape(1, 3, 1, 1, 8, 8)
    tables = (tables * scale + 0.5).floor().clamp(1, 255)
    blocks = parts.reshape(many, 3, height // 8, 8, width // 8, 8).permute(0, 1, 2, 4, 3, 5)
    waves = cosines @ blocks @ cosines.T
    blocks = cosines.T @ ((waves / tables).round() * tables) @ cosines
    parts = blocks.permute(0, 1, 2, 4, 3, 5).reshape(many, 3, height, width)
    parts = torch.cat([parts[:, :1] + 128, parts[:, 1:]], 1)
    return (torch.einsum("kc,nchw->nkhw", torch.linalg.inv(to), parts) / 255).clamp(0, 1)


def patches(photos, generator, many, size, hard):
    """Random parts of random photos as a camera might have taken them, 0 to 1 [patch, 3, size, size]; the numbers of
    their stones, 0 what is none; and of each pixel how far within, the stone's diameter as a power of two, and the way
    to its middle in diameters. `hard`: the share that is made harder."""
    device = photos.device
    draw = Draw(generator, many, device)
    which = torch.randint(len(photos), (many,), generator=generator, device=device)
    side = photos.image.shape[-1]
    # A turn of any angle needs room: as much smaller a part of the photo as it must.
    square = draw.happens(0.4)
    angle = torch.where(square > 0, (draw.unit() * 4).floor() * (math.pi / 2), draw.uniform(0, 2 * math.pi))
    room = angle.cos().abs() + angle.sin().abs()
    zoom = torch.maximum(2 ** draw.uniform(-1.0, 1.4), size * room / side * 1.001)
    flip = 1 - 2 * draw.happens(0.5)
    cos, sin = angle.cos() / zoom, angle.sin() / zoom
    middle = [0.5 * size * room / zoom + draw.unit() * (side - size * room / zoom) for _ in range(2)]

    def grid(steps):
        at = (torch.arange(steps, device=device, dtype=torch.float32) + 0.5) * (size / steps) - size / 2
        x, y = at[None, None, None, :] * flip, at[None, None, :, None]
        x, y = cos * x - sin * y + middle[0], sin * x + cos * y + middle[1]
        return torch.stack([x, y], 4)[:, 0] * (2 / side) - 1

    # Twice as fine and the mean of four: none of the photo is jumped over where it gets smaller.
    image = F.grid_sample(photos.image[which].float() / 255, grid(2 * size), "bicubic", "border", align_corners=False)
    image = F.avg_pool2d(image, 2).clamp(0, 1)
    nearest = grid(size)
    own = F.grid_sample(photos.own[which][:, None].float(), nearest, "nearest", "border", align_corners=False).long()
    maps = F.grid_sample(photos.maps[which].float(), nearest, "nearest", "border", align_corners=False)
    within, across, to = maps.split([1, 1, 2], 1)
    across = across + zoom.log2()
    # What is seen is turned back.
    x, y = to.split(1, 1)
    cos, sin = angle.cos(), angle.sin()
    to = torch.cat([flip * (cos * x + sin * y), cos * y - sin * x], 1)
    own = torch.where(across > 0.5 * math.log2(4 / math.pi * LEAST_PIXELS), own, 0)
    rock = (own > 0).float()
    within, across, to = within * rock, across * rock, to * rock
    linear = image ** 2.2
    linear = torch.where(draw.happens(hard) > 0, harder(linear, own, 2 ** across, to, draw), linear)
    return taken(lit(linear, draw), draw), own, within, across, to


def targets(own, within, across, to):
    """What the network is to say, each 0 to 1 [patch, 6, size, size]: border (a pixel beside another fragment or what is
    none), rock (a fragment rather than fines, floor, anything else), middle, size, and the way to the middle, half
    where there is none."""
    border = torch.zeros_like(own, dtype=torch.bool)
    for axis in (2, 3):
        length = own.shape[axis]
        differs = own.narrow(axis, 0, length - 1) != own.narrow(axis, 1, length - 1)
        border.narrow(axis, 0, length - 1).logical_or_(differs)
        border.narrow(axis, 1, length - 1).logical_or_(differs)
    return torch.cat([border.float(), (own > 0).float(), within, (across / SIZES).clamp(0, 1), (0.5 + 0.5 * to).clamp(0, 1)], 1)


def normalised(image):
    """Less the photo's mean, over its standard deviation (both over all pixels and channels)."""
    mean, deviation = image.mean((1, 2, 3), keepdim=True), image.std((1, 2, 3), keepdim=True, correction=0)
    return (image - mean) / (deviation + 1e-3)
