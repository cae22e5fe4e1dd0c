// A small face of simavr: run until something happens, and say what.
//
// Corrected here: simavr lets a byte of 8N1 take 11 bits; cycles_per_byte is set to 10 whenever it changes. Its
// transmitters have no buffer before the shift register; here they do, as in the data sheet (UDRE rises when a byte
// moves on to be shifted out, TXC when the last one is out). Its receivers hold 64 bytes and hand out one that has only
// begun when another was read late; here a byte is there when its stop bit is, and the fourth unread one is lost. Its ADC
// converts once where it is told to go on and on; here it goes on. Polling a USART never sleeps on the host. The ADC gets its
// voltages. Its watchdog counts 32 ms where the data sheet says 28.1 at 5 V, and stays on after its reset; here its period
// is the caller's, and a reset switches it off.

#include <stdlib.h>
#include <string.h>
#include "sim_avr.h"
#include "sim_elf.h"
#include "sim_io.h"
#include "avr_uart.h"
#include "avr_ioport.h"
#include "avr_eeprom.h"
#include "avr_adc.h"
#include "avr_watchdog.h"

enum { EVENT_BUS = 1, EVENT_LINK = 2, EVENT_PORT_E = 3, EVENT_PORT_B = 4, EVENT_RESET = 5, EVENT_PORT_C = 6, EVENT_MARK = 7 };

struct event { uint64_t cycle; uint32_t kind; uint32_t value; };
#define EVENTS 256

// Two bytes and one in the shift register.
enum { RECEIVER_HOLDS = 3 };

struct receiver {
	avr_uart_t *uart;
	uint8_t bytes[RECEIVER_HOLDS];
	int waiting;
	uint32_t lost;
};

struct transmitter {
	struct rig *rig;
	avr_uart_t *uart;
	int shifting; // a byte is on the line
	int held; // another waits in the data register
};

struct rig {
	avr_t *avr;
	uint32_t millivolts[8];
	uint8_t low[8]; // pins held low from outside, of ports A to H
	struct transmitter transmitter[2];
	struct receiver receiver[2];
	avr_uart_t *uart[2];
	uint64_t corrected[2];
	struct event events[EVENTS];
	uint32_t used;
	void (*core_reset)(avr_t *);
	avr_watchdog_t *watchdog;
	int (*watchdog_ioctl)(avr_io_t *, uint32_t, void *);
	void (*watchdog_reset)(avr_io_t *);
	uint32_t watchdog_us; // of 32768 of its cycles
	uint64_t fed; // when it was fed last, or reset
	uint64_t longest_unfed;
};

static struct rig *the_resetting;

static void note(struct rig *rig, uint32_t kind, uint32_t value) {
	if (rig->used < EVENTS) {
		struct event e = { rig->avr->cycle, kind, value };
		rig->events[rig->used++] = e;
	}
}

// The flag too, which simavr leaves to its own handlers.
static void clear(avr_t *avr, avr_int_vector_t *vector) {
	avr_clear_interrupt(avr, vector);
	avr_regbit_clear(avr, vector->raised);
}

static void hold(struct transmitter *t, int held) {
	t->held = held;
	// What simavr asks when UDRIE is set: whether to raise UDRE at once.
	t->uart->tx_cnt = held;
}

static avr_cycle_count_t moved_on(avr_t *avr, avr_cycle_count_t when, void *param) {
	struct transmitter *t = param;
	hold(t, 0);
	avr_raise_interrupt(avr, &t->uart->udrc);
	return 0;
}

static avr_cycle_count_t shifted_out(avr_t *avr, avr_cycle_count_t when, void *param) {
	struct transmitter *t = param;
	if (t->held) {
		moved_on(avr, when, t);
		return when + t->uart->cycles_per_byte;
	}
	t->shifting = 0;
	avr_raise_interrupt(avr, &t->uart->txc);
	return 0;
}

// The data register is written. Until a byte moves on it takes up to one bit.
static void on_data(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param) {
	struct transmitter *t = param;
	avr_core_watch_write(avr, address, value);
	if (!avr_regbit_get(avr, t->uart->txen)) return;
	clear(avr, &t->uart->udrc);
	hold(t, 1);
	if (!t->shifting) {
		t->shifting = 1;
		avr_cycle_timer_register(avr, 16, moved_on, t);
		avr_cycle_timer_register(avr, t->uart->cycles_per_byte, shifted_out, t);
	}
	note(t->rig, t->uart->name == '0' ? EVENT_BUS : EVENT_LINK, value);
}

static void raise_received(avr_t *avr, struct receiver *r) {
	// Its level, not its edge, calls the interrupt.
	if (r->waiting && !r->uart->rxc.pending) avr_raise_interrupt(avr, &r->uart->rxc);
}

// The data register is read.
static uint8_t on_taken(avr_t *avr, avr_io_addr_t address, void *param) {
	struct receiver *r = param;
	if (r->waiting) {
		avr->data[address] = r->bytes[0];
		r->waiting--;
		memmove(r->bytes, r->bytes + 1, r->waiting);
	}
	clear(avr, &r->uart->rxc);
	raise_received(avr, r);
	return avr_core_watch_read(avr, address);
}

enum { ADC_LOW = 0x24, ADC_HIGH = 0x25, ADC_STATUS = 0x26, ADC_CHANNEL = 0x27, ADC_FREE_RUNNING = 0x80 | 0x20 };

// The low byte of a conversion is read: the voltage on the channel chosen, if the ADC runs freely.
static uint8_t on_converted(avr_t *avr, avr_io_addr_t address, void *param) {
	struct rig *rig = param;
	if ((avr->data[ADC_STATUS] & ADC_FREE_RUNNING) == ADC_FREE_RUNNING) {
		uint32_t code = rig->millivolts[avr->data[ADC_CHANNEL] & 7] * 1023 / avr->avcc;
		avr->data[ADC_LOW] = code;
		avr->data[ADC_HIGH] = code >> 8;
	}
	return avr_core_watch_read(avr, address);
}

static uint8_t on_converted_high(avr_t *avr, avr_io_addr_t address, void *param) {
	return avr_core_watch_read(avr, address);
}

static void idle_usarts(struct rig *rig) {
	for (int i = 0; i < 2; i++) {
		rig->receiver[i].waiting = 0;
		struct transmitter *t = &rig->transmitter[i];
		avr_cycle_timer_cancel(rig->avr, moved_on, t);
		avr_cycle_timer_cancel(rig->avr, shifted_out, t);
		t->shifting = 0;
		hold(t, 0);
	}
}

static void on_port_e(struct avr_irq_t *irq, uint32_t value, void *param) { note(param, EVENT_PORT_E, value & 0xff); }
static void on_port_b(struct avr_irq_t *irq, uint32_t value, void *param) { note(param, EVENT_PORT_B, value & 0xff); }
static void on_port_c(struct avr_irq_t *irq, uint32_t value, void *param) { note(param, EVENT_PORT_C, value & 0xff); }
static void on_port_a(struct avr_irq_t *irq, uint32_t value, void *param) { note(param, EVENT_MARK, value & 0xff); }

// Each rig is used by one thread, and a reset happens within its rig_run.
static __thread struct rig *running;

static uint64_t since_fed(struct rig *rig) {
	return rig->avr->cycle - rig->fed;
}

// The program feeds the watchdog.
static int on_watchdog(avr_io_t *io, uint32_t control, void *param) {
	struct rig *rig = io->avr->custom.data;
	if (control == AVR_IOCTL_WATCHDOG_RESET) {
		if (since_fed(rig) > rig->longest_unfed) rig->longest_unfed = since_fed(rig);
		rig->fed = rig->avr->cycle;
		uint32_t cycles = avr_regbit_get_array(rig->avr, rig->watchdog->wdp, 3);
		rig->watchdog->cycle_count = (((uint64_t)rig->watchdog_us * 16) << cycles) / 2;
	}
	return rig->watchdog_ioctl ? rig->watchdog_ioctl(io, control, param) : -1;
}

static void on_watchdog_reset(avr_io_t *io) {
	struct rig *rig = io->avr->custom.data;
	if (rig->watchdog_reset) rig->watchdog_reset(io);
	avr_regbit_clear(rig->avr, rig->watchdog->wde);
}

static void on_reset(avr_t *avr) {
	if (running && running->avr == avr) {
		running->fed = avr->cycle;
		note(running, EVENT_RESET, 0);
		idle_usarts(running);
		if (running->core_reset) running->core_reset(avr);
	}
}

static void no_sleep(avr_t *avr, avr_cycle_count_t cycles) {}
static void no_log(avr_t *avr, const int level, const char *format, va_list ap) {}

static avr_uart_t *find_uart(avr_t *avr, char name) {
	for (avr_io_t *io = avr->io_port; io; io = io->next)
		if (io->kind && !strcmp(io->kind, "uart") && ((avr_uart_t *)io)->name == name)
			return (avr_uart_t *)io;
	return NULL;
}

struct rig *rig_new(const char *elf) {
	elf_firmware_t firmware;
	memset(&firmware, 0, sizeof firmware);
	avr_global_logger_set(no_log);
	if (elf_read_firmware(elf, &firmware)) return NULL;
	struct rig *rig = calloc(1, sizeof *rig);
	avr_t *avr = rig->avr = avr_make_mcu_by_name("atmega128");
	if (!avr) { free(rig); return NULL; }
	avr_init(avr);
	avr->log = LOG_NONE;
	avr->frequency = 16000000;
	firmware.frequency = 16000000;
	avr_load_firmware(avr, &firmware);
	avr->vcc = avr->avcc = avr->aref = 5000;
	avr->sleep = no_sleep;
	avr->run_cycle_limit = 40;
	rig->core_reset = avr->reset;
	avr->reset = on_reset;
	for (int i = 0; i < 2; i++) {
		uint32_t flags = 0;
		rig->uart[i] = find_uart(avr, '0' + i);
		avr_ioctl(avr, AVR_IOCTL_UART_GET_FLAGS('0' + i), &flags);
		flags &= ~(AVR_UART_FLAG_POLL_SLEEP | AVR_UART_FLAG_STDIO);
		avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0' + i), &flags);
		struct transmitter transmitter = { rig, rig->uart[i], 0, 0 };
		rig->transmitter[i] = transmitter;
		avr_io_addr_t data = AVR_DATA_TO_IO(rig->uart[i]->r_udr);
		avr->io[data].w.c = on_data;
		avr->io[data].w.param = &rig->transmitter[i];
		rig->receiver[i].uart = rig->uart[i];
		avr->io[data].r.c = on_taken;
		avr->io[data].r.param = &rig->receiver[i];
	}
	avr->custom.data = rig;
	rig->watchdog_us = 28100;
	for (avr_io_t *io = avr->io_port; io; io = io->next)
		if (io->kind && !strcmp(io->kind, "watchdog")) {
			rig->watchdog = (avr_watchdog_t *)io;
			rig->watchdog_ioctl = io->ioctl;
			rig->watchdog_reset = io->reset;
			io->ioctl = on_watchdog;
			io->reset = on_watchdog_reset;
		}
	avr->io[AVR_DATA_TO_IO(ADC_LOW)].r.c = on_converted;
	avr->io[AVR_DATA_TO_IO(ADC_LOW)].r.param = rig;
	avr->io[AVR_DATA_TO_IO(ADC_HIGH)].r.c = on_converted_high;
	avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('E'), IOPORT_IRQ_REG_PORT), on_port_e, rig);
	avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('B'), IOPORT_IRQ_REG_PORT), on_port_b, rig);
	avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('C'), IOPORT_IRQ_REG_PORT), on_port_c, rig);
	avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('A'), IOPORT_IRQ_REG_PORT), on_port_a, rig);
	return rig;
}

void rig_free(struct rig *rig) {
	avr_terminate(rig->avr);
	free(rig);
}

// Runs until the cycle is reached or something happened. 0: time is up, 1: events, -1: the core crashed.
int rig_run(struct rig *rig, uint64_t until) {
	avr_t *avr = rig->avr;
	running = rig;
	while (avr->cycle < until && rig->used == 0) {
		int state = avr_run(avr);
		for (int i = 0; i < 2; i++) {
			avr_uart_t *uart = rig->uart[i];
			if (uart->cycles_per_byte != rig->corrected[i])
				rig->corrected[i] = uart->cycles_per_byte = uart->cycles_per_byte * 10 / 11;
			if (avr_regbit_get(avr, uart->rxc.enable)) raise_received(avr, &rig->receiver[i]);
		}
		if (state == cpu_Done || state == cpu_Crashed) return -1;
	}
	return rig->used != 0;
}

uint32_t rig_events(struct rig *rig, struct event *out, uint32_t room) {
	uint32_t count = rig->used < room ? rig->used : room;
	memcpy(out, rig->events, count * sizeof *out);
	rig->used = 0;
	return count;
}

uint64_t rig_cycle(struct rig *rig) { return rig->avr->cycle; }
uint8_t *rig_data(struct rig *rig) { return rig->avr->data; }
uint8_t *rig_flash(struct rig *rig) { return rig->avr->flash; }
uint32_t rig_pc(struct rig *rig) { return rig->avr->pc; }
uint64_t rig_byte_cycles(struct rig *rig, int uart) { return rig->uart[uart]->cycles_per_byte; }
// Bytes received and not yet read by the firmware.
int rig_waiting(struct rig *rig, int uart) { return rig->receiver[uart].waiting; }
// Bytes that found no room, for the firmware read too late.
uint32_t rig_lost(struct rig *rig, int uart) { return rig->receiver[uart].lost; }

// A byte's stop bit has arrived.
void rig_uart_in(struct rig *rig, int uart, uint8_t byte) {
	struct receiver *r = &rig->receiver[uart];
	if (!avr_regbit_get(rig->avr, r->uart->rxen)) return;
	if (r->waiting == RECEIVER_HOLDS) {
		r->lost++;
		return;
	}
	r->bytes[r->waiting++] = byte;
	raise_received(rig->avr, r);
}

// Held, or simavr would let the pull-up raise it whenever its port is written.
void rig_pin(struct rig *rig, char port, int pin, int level) {
	uint8_t *low = &rig->low[(port - 'A') & 7];
	*low = level ? *low & ~(1 << pin) : *low | 1 << pin;
	avr_ioport_external_t held = { .name = port, .mask = *low, .value = 0 };
	avr_ioctl(rig->avr, AVR_IOCTL_IOPORT_SET_EXTERNAL(port), &held);
	avr_raise_irq(avr_io_getirq(rig->avr, AVR_IOCTL_IOPORT_GETIRQ(port), IOPORT_IRQ_PIN0 + pin), level);
}

void rig_adc(struct rig *rig, int channel, uint32_t millivolts) {
	rig->millivolts[channel & 7] = millivolts;
}

// The pending EEPROM byte, if one is being written, is left to the caller to spoil.
uint8_t *rig_eeprom(struct rig *rig) {
	avr_eeprom_desc_t all = { .ee = NULL, .offset = 0, .size = 0 };
	avr_ioctl(rig->avr, AVR_IOCTL_EEPROM_GET, &all);
	return all.ee;
}

// The watchdog's period from its next feeding on, us of 32768 of its cycles.
void rig_watchdog(struct rig *rig, uint32_t us) { rig->watchdog_us = us; }

// The longest time without feeding since the last call, cycles.
uint64_t rig_longest_unfed(struct rig *rig) {
	uint64_t longest = rig->longest_unfed;
	rig->longest_unfed = 0;
	return longest;
}

// Where a reset leads, and going on elsewhere: for who models a boot loader.
void rig_reset_to(struct rig *rig, uint32_t pc) { rig->avr->reset_pc = pc; }
void rig_jump(struct rig *rig, uint32_t pc) { rig->avr->pc = pc; }

// Power off and on again: as a reset with the power-on flag.
void rig_power_cycle(struct rig *rig) {
	running = rig;
	avr_reset(rig->avr);
}
