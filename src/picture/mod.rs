//! Pixels of photos: undistorting, reducing, drawing on them.
