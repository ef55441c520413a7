//! The program in a window on an X server, a keyboard for it, and eyes on its pixels.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};

use firsthit::{Image, Stage};
use tempfile::TempDir;
use x11rb::connection::Connection as _;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    AtomEnum, BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ClientMessageEvent, ConfigureWindowAux,
    ConnectionExt as _, CreateWindowAux, EventMask, InputFocus, KEY_PRESS_EVENT, KEY_RELEASE_EVENT,
    MOTION_NOTIFY_EVENT, MapState, PropMode, Window, WindowClass,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

use super::pixels::{Expected, Pixels, letterboxed, placed, traced, wait_to_show};
use super::program::{Program, wait_for};
use super::shared_image::SharedImage;
use super::xvfb::Xvfb;

pub const SHIFT: u32 = 0xffe1;
pub const CONTROL: u32 = 0xffe3;
pub const SPACE: u32 = 0x20;
pub const ESCAPE: u32 = 0xff1b;
pub const HOME: u32 = 0xff50;
pub const PAGE_UP: u32 = 0xff55;
pub const PAGE_DOWN: u32 = 0xff56;
pub const LEFT: u32 = 0xff51;
pub const RIGHT: u32 = 0xff53;

pub const DOWN: u32 = 0xff54;
pub const UP: u32 = 0xff52;
pub const ENTER: u32 = 0xff0d;
pub const F1: u32 = 0xffbe;

pub const LEFT_BUTTON: u8 = 1;
pub const RIGHT_BUTTON: u8 = 3;
pub const WHEEL_UP: u8 = 4;
pub const WHEEL_DOWN: u8 = 5;

/// The colour of a panel's ground.
const PANEL: [u8; 3] = [24, 24, 30];

/// A panel's width at scale factor 1: 54 characters and a margin of one on either side.
pub const PANEL_WIDTH: usize = 56 * 7;

/// The viewer with its window on a display of its own.
pub struct Session {
    pub program: Program,
    pub connection: RustConnection,
    pub root: Window,
    pub window: Window,
    image: OnceCell<SharedImage>,
    xvfb: Option<Xvfb>,
    pub folder: TempDir,
}

impl Session {
    /// Starts the program with `arguments` under an Xvfb, waits for its first frame and gives it
    /// the keyboard. `None` where there is no Xvfb.
    pub fn start(arguments: &[&str]) -> Option<Session> {
        Some(Session::on(Xvfb::lent()?, arguments, &[]))
    }

    /// The same on an Xvfb that runs, with further variables in the program's environment.
    pub fn on(xvfb: Xvfb, arguments: &[&str], environment: &[(&str, &str)]) -> Session {
        let folder = tempfile::tempdir().unwrap();
        let session = Session::starting(xvfb, folder, arguments, environment);
        session.program.line("first frame");
        session.opened()
    }

    /// The program, which is just starting in `folder` and need not say that it has a window.
    pub fn starting(
        xvfb: Xvfb,
        folder: TempDir,
        arguments: &[&str],
        environment: &[(&str, &str)],
    ) -> Session {
        let (connection, screen) = x11rb::connect(Some(&xvfb.display)).unwrap();
        let root = connection.setup().roots[screen].root;
        let display = ("DISPLAY", xvfb.display.as_str());
        let environment = [environment, &[display]].concat();
        let program = Program::start(folder.path(), arguments, &environment);
        Session {
            program,
            connection,
            root,
            window: x11rb::NONE,
            image: OnceCell::new(),
            xvfb: Some(xvfb),
            folder,
        }
    }

    /// The same once its window can be seen, with the keyboard.
    pub fn opened(mut self) -> Session {
        self.window = wait_for("the window", || self.find());
        self.focus();
        self
    }

    /// The window of the program, once it can be seen.
    fn find(&self) -> Option<Window> {
        let tree = self.connection.query_tree(self.root).unwrap();
        let children = tree.reply().unwrap().children;
        children.into_iter().find(|&child| {
            let attributes = self.connection.get_window_attributes(child).unwrap();
            self.title_of(child).starts_with("firsthit ")
                && attributes
                    .reply()
                    .is_ok_and(|attributes| attributes.map_state == MapState::VIEWABLE)
        })
    }

    fn focus(&self) {
        wait_for("the keyboard", || {
            let connection = &self.connection;
            connection
                .set_input_focus(InputFocus::POINTER_ROOT, self.window, x11rb::CURRENT_TIME)
                .unwrap();
            let focus = connection.get_input_focus().unwrap().reply().unwrap().focus;
            (focus == self.window).then_some(())
        });
    }

    fn atom(&self, name: &str) -> u32 {
        let atom = self.connection.intern_atom(false, name.as_bytes()).unwrap();
        atom.reply().unwrap().atom
    }

    fn title_of(&self, window: Window) -> String {
        let (name, text) = (self.atom("_NET_WM_NAME"), self.atom("UTF8_STRING"));
        let property = self
            .connection
            .get_property(false, window, name, text, 0, 1000)
            .unwrap();
        property
            .reply()
            .map(|property| String::from_utf8(property.value).unwrap())
            .unwrap_or_default()
    }

    pub fn title(&self) -> String {
        self.title_of(self.window)
    }

    /// Waits for a title that holds each of `parts`.
    pub fn titled(&self, parts: &[&str]) {
        wait_for(&format!("a title with {parts:?}"), || {
            let title = self.title();
            parts.iter().all(|part| title.contains(part)).then_some(())
        });
    }

    /// α as the title says it.
    pub fn alpha(&self) -> f64 {
        let title = self.title();
        let (_, alpha) = title.split_once("α = ").unwrap();
        alpha.split(' ').next().unwrap().parse().unwrap()
    }

    /// The keycode that gives `keysym`, and whether it needs Shift.
    pub fn keycode(&self, keysym: u32) -> (u8, bool) {
        let setup = self.connection.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let mapping = self
            .connection
            .get_keyboard_mapping(first, last - first + 1)
            .unwrap()
            .reply()
            .unwrap();
        let columns = usize::from(mapping.keysyms_per_keycode);
        let at = |column: usize| {
            let mut keys = mapping.keysyms.chunks(columns);
            keys.position(|keysyms| keysyms.get(column) == Some(&keysym))
        };
        let (key, shift) = match at(0) {
            Some(key) => (key, false),
            None => (at(1).expect("a key with this symbol"), true),
        };
        (first + u8::try_from(key).unwrap(), shift)
    }

    fn fake(&self, event: u8, keycode: u8) {
        self.connection
            .xtest_fake_input(event, keycode, x11rb::CURRENT_TIME, self.root, 0, 0, 0)
            .unwrap()
            .check()
            .unwrap();
    }

    /// Presses and releases the key at `keycode`.
    pub fn press_code(&self, keycode: u8) {
        self.fake(KEY_PRESS_EVENT, keycode);
        self.fake(KEY_RELEASE_EVENT, keycode);
    }

    /// Presses and releases the key with the symbol `keysym`, with Shift where it needs it.
    pub fn press(&self, keysym: u32) {
        let (keycode, shift) = self.keycode(keysym);
        if shift {
            self.press_shifted(keycode);
        } else {
            self.press_code(keycode);
        }
    }

    /// Presses the key at `keycode` while Shift is down.
    pub fn press_shifted(&self, keycode: u8) {
        self.press_with(SHIFT, keycode);
    }

    /// Presses the key with the symbol `keysym` while Ctrl is down.
    pub fn press_ctrl(&self, keysym: u32) {
        self.press_with(CONTROL, self.keycode(keysym).0);
    }

    fn press_with(&self, modifier: u32, keycode: u8) {
        let (modifier, _) = self.keycode(modifier);
        self.fake(KEY_PRESS_EVENT, modifier);
        self.press_code(keycode);
        self.fake(KEY_RELEASE_EVENT, modifier);
    }

    /// Types `keys`, each a character of ASCII.
    pub fn type_keys(&self, keys: &str) {
        for key in keys.chars() {
            self.press(u32::from(key));
        }
    }

    /// The text on the clipboard, waited for, as another program gets it.
    pub fn clipboard(&self) -> String {
        let connection = &self.connection;
        let window = connection.generate_id().unwrap();
        let attributes = CreateWindowAux::new();
        connection
            .create_window(
                x11rb::COPY_DEPTH_FROM_PARENT,
                window,
                self.root,
                0,
                0,
                1,
                1,
                0,
                WindowClass::INPUT_ONLY,
                x11rb::COPY_FROM_PARENT,
                &attributes,
            )
            .unwrap();
        let (clipboard, text) = (self.atom("CLIPBOARD"), self.atom("UTF8_STRING"));
        wait_for("text on the clipboard", || {
            let now = x11rb::CURRENT_TIME;
            connection
                .convert_selection(window, clipboard, text, text, now)
                .unwrap();
            connection.flush().unwrap();
            let answer = wait_for("the clipboard's answer", || {
                match connection.poll_for_event().unwrap()? {
                    Event::SelectionNotify(answer) => Some(answer),
                    _ => None,
                }
            });
            let property = connection
                .get_property(true, window, text, text, 0, u32::MAX)
                .unwrap()
                .reply()
                .unwrap();
            (answer.property == text).then(|| String::from_utf8(property.value).unwrap())
        })
    }

    /// Moves the pointer to the pixel of the window at `x` and `y`, counted from its top left
    /// corner.
    pub fn point(&self, x: i16, y: i16) {
        let place = self
            .connection
            .translate_coordinates(self.window, self.root, x, y);
        let place = place.unwrap().reply().unwrap();
        self.connection
            .xtest_fake_input(
                MOTION_NOTIFY_EVENT,
                0,
                x11rb::CURRENT_TIME,
                self.root,
                place.dst_x,
                place.dst_y,
                0,
            )
            .unwrap()
            .check()
            .unwrap();
    }

    /// Presses a button of the mouse, or lets go of it. 4 is the wheel turned away from the person,
    /// 5 toward the person.
    pub fn button(&self, button: u8, down: bool) {
        let event = if down {
            BUTTON_PRESS_EVENT
        } else {
            BUTTON_RELEASE_EVENT
        };
        self.fake(event, button);
    }

    pub fn click(&self, button: u8) {
        self.button(button, true);
        self.button(button, false);
    }

    /// Gives the window another size.
    pub fn resize(&self, width: u32, height: u32) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        self.connection
            .configure_window(self.window, &size)
            .unwrap()
            .check()
            .unwrap();
    }

    pub fn size(&self) -> (usize, usize) {
        let geometry = self.connection.get_geometry(self.window).unwrap();
        let geometry = geometry.reply().unwrap();
        (geometry.width.into(), geometry.height.into())
    }

    /// Takes the window from the screen as a window manager does that makes an icon of it, or puts
    /// it back.
    pub fn iconify(&self, iconic: bool) {
        let hidden = self.atom("_NET_WM_STATE_HIDDEN");
        let state: &[u32] = if iconic { &[hidden] } else { &[] };
        let property = self.atom("_NET_WM_STATE");
        self.connection
            .change_property32(
                PropMode::REPLACE,
                self.window,
                property,
                AtomEnum::ATOM,
                state,
            )
            .unwrap();
        let done = if iconic {
            self.connection.unmap_window(self.window)
        } else {
            self.connection.map_window(self.window)
        };
        done.unwrap().check().unwrap();
        if !iconic {
            self.focus();
        }
    }

    /// What the window shows, if it can be read.
    pub fn pixels(&self) -> Option<Pixels> {
        let shared = self
            .image
            .get_or_init(|| SharedImage::new(&self.connection));
        shared.of(&self.connection, self.window, self.size())
    }

    /// Waits until the window shows the picture of N = `size`, `stage` and `alpha`, as it was
    /// traced, byte for byte.
    #[track_caller]
    pub fn shows(&self, size: u32, stage: Stage, alpha: f64) {
        let picture = traced(size, stage, alpha);
        self.shows_pixels(|width, height| letterboxed(&picture, width, height));
    }

    /// The same, with the picture as a square of `extent` pixels whose bottom left corner lies at
    /// `corner`.
    #[track_caller]
    pub fn shows_placed(&self, picture: &Image, corner: [i64; 2], extent: usize) {
        self.shows_pixels(|width, height| placed(picture, width, height, corner, extent));
    }

    /// Waits until the window shows what a window of its width and height should.
    #[track_caller]
    fn shows_pixels(&self, expected: impl Fn(usize, usize) -> Pixels) {
        wait_to_show(|| self.pixels(), expected);
    }

    /// Waits until something lies over at least so many hundredths of the window, which shows the
    /// picture of N = `size`, `stage` and `alpha`, and keeps it to be looked at.
    #[track_caller]
    pub fn covers(&self, size: u32, stage: Stage, alpha: f64, percent: usize, name: &str) {
        let picture = traced(size, stage, alpha);
        let mut uncovered = Expected::new(|width, height| letterboxed(&picture, width, height));
        wait_for(&format!("{name} over the picture"), || {
            let (width, height) = self.size();
            let uncovered = uncovered.of(width, height);
            let covered = self.pixels()?.differences(uncovered, 0..height);
            (100 * covered >= percent * width * height).then_some(())
        });
        self.screenshot(name);
    }

    /// Waits until a panel with text stands to the right of the picture's part of the window,
    /// `width` pixels wide, which shows all of the picture of N = `size`, `stage` and `alpha`,
    /// and keeps it to be looked at. Only the ring around an inspected pixel, `ringed` from the
    /// left and the top, may lie over the picture.
    #[track_caller]
    pub fn shows_beside_panel(
        &self,
        width: usize,
        (size, stage, alpha): (u32, Stage, f64),
        ringed: Option<[usize; 2]>,
        name: &str,
    ) {
        let picture = traced(size, stage, alpha);
        let mut expected = Expected::new(|width, height| letterboxed(&picture, width, height));
        wait_for(&format!("{name} beside the picture"), || {
            let shown = self.pixels()?;
            let (whole, height) = (shown.width, shown.height);
            let panel = shown.part([width, 0], [whole, height]);
            let clean = panel.count(PANEL) * 2 > panel.bytes.len();
            let ink = panel.bytes.iter().filter(|[red, ..]| *red > 150);
            let expected = expected.of(width, height);
            let part = shown.part([0, 0], [width, height]);
            let pairs = part.bytes.iter().zip(&expected.bytes).enumerate();
            let wrong = pairs.filter(|(place, (shown, expected))| {
                let [x, y] = [place % width, place / width];
                let far =
                    ringed.is_none_or(|[left, top]| x.abs_diff(left).max(y.abs_diff(top)) > 8);
                far && shown != expected
            });
            let shows = expected.bytes.len() == part.bytes.len() && wrong.count() == 0;
            (clean && shows && ink.count() > 300).then_some(())
        });
        self.screenshot(name);
    }

    /// Waits until the window has this size.
    #[track_caller]
    pub fn becomes(&self, width: usize, height: usize) {
        wait_for(&format!("a window of {width} × {height}"), || {
            (self.size() == (width, height)).then_some(())
        });
    }

    /// The picture in the window as a PNG in the tests' folder for temporary files, to be looked
    /// at.
    pub fn screenshot(&self, name: &str) -> PathBuf {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        self.pixels().unwrap().save(&path);
        path
    }

    /// Closes the window as a window manager does on a click.
    pub fn close(&self) {
        let protocols = self.atom("WM_PROTOCOLS");
        let delete = self.atom("WM_DELETE_WINDOW");
        let data = [delete, x11rb::CURRENT_TIME, 0, 0, 0];
        let event = ClientMessageEvent::new(32, self.window, protocols, data);
        let none = EventMask::NO_EVENT;
        self.connection
            .send_event(false, self.window, none, event)
            .unwrap()
            .check()
            .unwrap();
    }

    /// Ends the X server at once.
    pub fn crash_server(&mut self) {
        self.xvfb.take().unwrap().crash();
    }
}
