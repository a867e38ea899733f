//! The view without a window: for pictures of it, and for tests.

use std::pin::pin;
use std::task::{Context, Poll, Waker};

use super::{Drawing, Gpu};

impl Gpu {
    /// By whatever adapter there is.
    ///
    /// # Errors
    /// In words, if there is none, or none that can do what the view needs.
    pub fn headless() -> Result<Self, String> {
        let instance = wgpu::Instance::default();
        let adapter = now(instance.request_adapter(&wgpu::RequestAdapterOptions::default()));
        let adapter = adapter.map_err(|error| format!("no graphics adapter: {error}"))?;
        let device = now(adapter.request_device(&wgpu::DeviceDescriptor::default()));
        let (device, queue) = device.map_err(|error| format!("no graphics device: {error}"))?;
        Self::new(&device, &queue)
    }

    /// Draws, waits, and reads: four bytes a pixel, sRGB, row after row from the top.
    ///
    /// # Errors
    /// What went wrong on the card.
    pub fn picture(&mut self, drawing: &Drawing) -> Result<Vec<u8>, String> {
        self.draw(drawing);
        self.wait()?;
        let [width, height] = drawing.view.size;
        let Some(target) = &self.target else { return Ok(Vec::new()) };
        // Rows of a copy begin at multiples of 256 bytes.
        let row = (4 * width).next_multiple_of(256);
        let room = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read"),
            size: u64::from(row) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            target.shown.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &room, layout },
            target.shown.size(),
        );
        self.queue.submit([encoder.finish()]);
        room.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.wait()?;
        let bytes = room.slice(..).get_mapped_range().map_err(|error| error.to_string())?;
        Ok(bytes.chunks(row as usize).flat_map(|bytes| &bytes[..4 * width as usize]).copied().collect())
    }

    /// Until all that was asked of the card is done.
    ///
    /// # Errors
    /// What went wrong on it.
    pub fn wait(&self) -> Result<(), String> {
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| error.to_string())?;
        self.failure().map_or(Ok(()), Err)
    }
}

/// What a future gives that is ready when it is asked or soon after, as all of wgpu's are outside of a browser.
pub(super) fn now<T>(future: impl Future<Output = T>) -> T {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(value) = future.as_mut().poll(&mut context) {
            return value;
        }
        std::thread::yield_now();
    }
}
