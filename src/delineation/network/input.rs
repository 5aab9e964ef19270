//! A part of a photo as the numbers that a network takes.

use image::RgbImage;
use rten::Value;

use super::parts::{Part, mirrored};

/// The order of a tensor's sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Layout {
    /// Picture, channel, row, column.
    ChannelsFirst,
    /// Picture, row, column, channel.
    ChannelsLast,
}

/// Which channels, in which order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Channels {
    Rgb,
    Bgr,
    /// The brightness alone (ITU-R BT.601's weights).
    Gray,
}

impl Channels {
    pub(crate) fn count(self) -> usize {
        match self {
            Self::Rgb | Self::Bgr => 3,
            Self::Gray => 1,
        }
    }
}

/// What is taken from the values, and what they are then divided by.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Normal {
    /// The photo's own mean and standard deviation, over all pixels and channels.
    OfPhoto,
    /// These, channel by channel.
    Given(Vec<[f32; 2]>),
}

/// How a photo is brought to a network.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Input {
    pub(crate) layout: Layout,
    pub(crate) channels: Channels,
    /// What white is before the mean is taken from it.
    pub(crate) white: f32,
    pub(crate) normal: Normal,
    /// Whether the network wants bytes: values as the photo has them.
    pub(crate) bytes: bool,
}

impl Input {
    /// The mean and the deviation of each channel in that photo.
    pub(crate) fn normals(&self, photo: &RgbImage) -> Vec<[f32; 2]> {
        match &self.normal {
            Normal::Given(of) => of.clone(),
            Normal::OfPhoto => {
                let (mean, deviation) = mean_and_deviation(photo);
                vec![[mean * self.white, deviation * self.white]; self.channels.count()]
            }
        }
    }

    /// A part of the photo as a tensor.
    pub(crate) fn tensor(
        &self,
        photo: &RgbImage,
        part: &Part,
        normals: &[[f32; 2]],
    ) -> Option<Value> {
        let count = self.channels.count();
        let (width, height) = (photo.width() as usize, photo.height() as usize);
        let (columns, rows) = (part.columns, part.rows);
        let mut values = vec![0.0f32; columns * rows * count];
        let scale = self.white / 255.0;
        for row in 0..rows {
            let y = mirrored(part.above + row, height) as u32;
            for column in 0..columns {
                let x = mirrored(part.first + column, width) as u32;
                let [r, g, b] = photo.get_pixel(x, y).0.map(f32::from);
                let own = match self.channels {
                    Channels::Rgb => [r, g, b],
                    Channels::Bgr => [b, g, r],
                    Channels::Gray => [0.299 * r + 0.587 * g + 0.114 * b; 3],
                };
                for (channel, (value, [mean, deviation])) in own.iter().zip(normals).enumerate() {
                    let place = match self.layout {
                        Layout::ChannelsFirst => (channel * rows + row) * columns + column,
                        Layout::ChannelsLast => (row * columns + column) * count + channel,
                    };
                    values[place] = match self.bytes {
                        true => *value,
                        false => (value * scale - mean) / deviation,
                    };
                }
            }
        }
        let shape = match self.layout {
            Layout::ChannelsFirst => [1, count, rows, columns],
            Layout::ChannelsLast => [1, rows, columns, count],
        };
        if self.bytes {
            let bytes: Vec<u8> = values.iter().map(|value| value.round() as u8).collect();
            Value::from_shape(shape, bytes).ok()
        } else {
            Value::from_shape(shape, values).ok()
        }
    }
}

/// Over all pixels and channels, of 0 to 1.
fn mean_and_deviation(photo: &RgbImage) -> (f32, f32) {
    let (mut sum, mut squares) = (0u64, 0u64);
    for part in photo.as_raw() {
        let part = u64::from(*part);
        sum += part;
        squares += part * part;
    }
    let count = photo.as_raw().len().max(1) as f64;
    let mean = sum as f64 / count / 255.0;
    let variance = squares as f64 / count / 255.0 / 255.0 - mean * mean;
    (mean as f32, variance.max(0.0).sqrt() as f32 + 1e-3)
}
